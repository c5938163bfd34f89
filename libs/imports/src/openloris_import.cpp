// SPDX-License-Identifier: BSD-3-Clause
// Images, odometry and ground truth of a sequence of OpenLORIS-Scene, whatever of them is there.
#include "roomgraph/imports/openloris_import.h"

#include <mrpt/core/Clock.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <algorithm>
#include <cstdio>
#include <opencv2/imgcodecs.hpp>

#include "openloris_files.h"
#include "ordered_records.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/text_file.h"
#include "roomgraph/datasets/import_images.h"
#include "roomgraph/datasets/import_output.h"
#include "roomgraph/datasets/picture_decoding.h"
#include "roomgraph/datasets/tum_lists.h"
#include "roomgraph/observations/mrpt_camera.h"

namespace roomgraph {
namespace openloris {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLabel = "D400";
constexpr const char* kCamera = "d400_color_optical_frame";
constexpr const char* kBase = "base_link";
constexpr double kFarthestInTime_s = 7'258'118'400;  // 2200-01-01
constexpr float kShownRangeM = 10;                   // for viewers only
constexpr double kWindowOfRecords_s = 5;

bool isTime(double t) {
  return t >= 0 && t < kFarthestInTime_s;
}

/// What is read of the folder, before any image.
struct Plan {
  std::vector<TumEntry> color, depth;
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  std::optional<PinholeCamera> camera;  ///< nothing: no images
  Pose3 robot_from_optical = Pose3::Identity();
  NumberTable odometry, truth;
};

void tellTable(const std::string& name, const NumberTable& table, std::vector<std::string>& warnings) {
  if (table.broken > 0)
    warnings.push_back(name + ": " + std::to_string(table.broken) +
                       " lines left out: not understood; first: line " + std::to_string(table.first_broken));
}

void planImages(const fs::path& folder, const OpenlorisImportOptions& options, Plan& plan,
                std::vector<std::string>& warnings) {
  for (const char* list : {"color.txt", "aligned_depth.txt"})
    if (!fs::is_regular_file(folder / list)) {
      warnings.push_back(std::string("images are left out: no ") + list);
      return;
    }
  if (options.camera) {
    plan.camera = options.camera;
  } else {
    const auto camera = readCamera(folder / "sensors.yaml", kCamera);
    if (!camera) {
      warnings.push_back("images are left out: " + camera.reason() + " (--camera FX,FY,CX,CY gives it)");
      return;
    }
    plan.camera = *camera;
  }
  if (!options.sensor_poses.contains(kLabel)) {
    const auto place = readPlace(folder / "trans_matrix.yaml", kBase, kCamera);
    if (!place)
      warnings.push_back(place.reason() +
                         ": the camera is taken to be at the robot's origin (--pose D400=... places it)");
    Pose3 forward = Pose3::Identity();
    forward.linear() = bodyFromOptical();
    plan.robot_from_optical = place ? *place : forward;
  }
  plan.color = readTumEntries(folder / "color.txt", warnings);
  plan.depth = readTumEntries(folder / "aligned_depth.txt", warnings);
  plan.pairs = pairByTime(plan.color, plan.depth, options.max_time_difference_s);
}

void planTables(const fs::path& folder, Plan& plan, std::vector<std::string>& warnings) {
  constexpr std::size_t kOdometryColumns = 14, kPoseColumns = 8;
  if (fs::is_regular_file(folder / "odom.txt")) {
    plan.odometry = readTable(folder / "odom.txt", kOdometryColumns);
    tellTable("odom.txt", plan.odometry, warnings);
  } else {
    warnings.push_back("no odom.txt: no odometry");
  }
  if (!fs::is_regular_file(folder / "groundtruth.txt")) return;
  plan.truth = readTable(folder / "groundtruth.txt", kPoseColumns);
  tellTable("groundtruth.txt", plan.truth, warnings);
}

struct Times {
  double first = 0, last = 0;
};

template <class List, class Time>
Times timesOf(const List& list, const Time& time) {
  Times times{time(list.front()), time(list.front())};
  for (const auto& entry : list)
    times = {std::min(times.first, time(entry)), std::max(times.last, time(entry))};
  return times;
}

// Recordings of one run have most of their time in common.
void checkClocks(const Plan& plan, std::vector<std::string>& warnings) {
  constexpr double kShare = 0.5;
  if (plan.color.empty()) return;
  const Times images = timesOf(plan.color, [](const TumEntry& entry) { return entry.t; });
  const auto check = [&](const char* name, const NumberTable& table) {
    if (table.rows.empty()) return;
    const Times times = timesOf(table.rows, [](const auto& row) { return row[0]; });
    const double common = std::min(times.last, images.last) - std::max(times.first, images.first);
    if (common >= kShare * std::min(times.last - times.first, images.last - images.first)) return;
    char text[200];
    std::snprintf(text, sizeof text,
                  "%s: is from t = %.3f to %.3f s, color.txt from %.3f to %.3f: their clocks disagree", name,
                  times.first, times.last, images.first, images.last);
    warnings.emplace_back(text);
  };
  check("odom.txt", plan.odometry);
  check("groundtruth.txt", plan.truth);
}

/// Records of the folder, and how many of what could not be made.
class SequenceRecords {
 public:
  SequenceRecords(const fs::path& folder, Plan plan, const OpenlorisImportOptions& options,
                  const ImportOutput& output, OrderedRecords& records)
      : folder_(folder), plan_(std::move(plan)), options_(options), output_(output), records_(records) {}

  void convert(const std::function<void(double)>& progress) {
    std::size_t row = 0;
    double last = -1;
    for (std::size_t i = 0; i < plan_.pairs.size(); ++i) {
      const auto& [color, depth] = plan_.pairs[i];
      for (; row < plan_.odometry.rows.size() && plan_.odometry.rows[row][0] <= plan_.color[color].t; ++row)
        takeOdometry(plan_.odometry.rows[row], last);
      takeImages(plan_.color[color], plan_.depth[depth]);
      if (progress) progress(static_cast<double>(i) / static_cast<double>(plan_.pairs.size()));
    }
    for (; row < plan_.odometry.rows.size(); ++row) takeOdometry(plan_.odometry.rows[row], last);
    if (const auto alone = plan_.color.size() - plan_.pairs.size(); alone > 0)
      skipped_["color.txt: no depth image of its time"] += static_cast<int>(alone);
    if (const auto alone = plan_.depth.size() - plan_.pairs.size(); alone > 0)
      skipped_["aligned_depth.txt: no colour image of its time"] += static_cast<int>(alone);
  }
  const std::map<std::string, int>& skipped() const { return skipped_; }

 private:
  void skip(const std::string& reason) { ++skipped_[reason]; }

  void takeOdometry(const std::vector<double>& row, double& last) {
    if (!isTime(row[0])) return skip("odom.txt: time is not between 1970 and 2200");
    if (row[0] == last) return skip("odom.txt: same time as the one before");
    last = row[0];
    const auto pose = poseOfRow(row, 1);
    if (!pose) return skip("odom.txt: " + pose.reason());
    const Pose2 planar = planarPart(*pose);
    auto odometry = mrpt::obs::CObservationOdometry::Create();
    odometry->timestamp = mrpt::Clock::fromDouble(row[0]);
    odometry->sensorLabel = "ODOMETRY";
    odometry->odometry = {planar.x, planar.y, planar.yaw};
    odometry->hasVelocities = true;
    odometry->velocityLocal = {row[8], row[9], row[13]};
    records_.push(odometry);
  }

  Outcome<cv::Mat> readPicture(const std::string& name, int flags) const {
    if (!fs::is_regular_file(folder_ / name)) return Outcome<cv::Mat>::failure("no such file");
    const std::string bytes = readTextFile(folder_ / name);
    return decodePicture({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, flags);
  }

  void takeImages(const TumEntry& color_entry, const TumEntry& depth_entry) {
    if (!isTime(color_entry.t)) return skip("color.txt: time is not between 1970 and 2200");
    const auto color = readPicture(color_entry.file, cv::IMREAD_COLOR);
    if (!color) return skip("color: " + color.reason());
    const auto depth = readPicture(depth_entry.file, cv::IMREAD_UNCHANGED);
    if (!depth) return skip("aligned_depth: " + depth.reason());
    if (depth->type() != CV_16UC1) return skip("aligned_depth: is not of 16 bit");
    PinholeCamera camera = *plan_.camera;
    if (camera.width == 0 || camera.height == 0) {
      camera.width = color->cols;
      camera.height = color->rows;
    }
    const cv::Size wanted(camera.width, camera.height);
    if (color->size() != wanted || depth->size() != wanted) return skip("images: not of the camera's size");
    auto record = mrpt::obs::CObservation3DRangeScan::Create();
    record->timestamp = mrpt::Clock::fromDouble(color_entry.t);
    record->sensorLabel = kLabel;
    record->hasIntensityImage = true;
    record->intensityImage = mrpt::img::CImage(*color, mrpt::img::DEEP_COPY);
    setDepth(*record, *depth);
    record->maxRange = kShownRangeM;
    record->cameraParams = record->cameraParamsIntensity = toMrpt(camera);
    record->sensorPose = toMrpt(place());
    if (options_.external_images) storeOutside(*record, {}, output_);
    records_.push(record);
  }

  // x forward.
  Pose3 place() const {
    const auto given = options_.sensor_poses.find(kLabel);
    if (given != options_.sensor_poses.end()) return given->second;
    Pose3 forward_from_optical = Pose3::Identity();
    forward_from_optical.linear() = bodyFromOptical();
    return plan_.robot_from_optical * forward_from_optical.inverse();
  }

  fs::path folder_;
  Plan plan_;
  const OpenlorisImportOptions& options_;
  const ImportOutput& output_;
  OrderedRecords& records_;
  std::map<std::string, int> skipped_;
};

std::string truthText(const NumberTable& truth, std::map<std::string, int>& skipped) {
  std::string text;
  double last = -1;
  for (const auto& row : truth.rows) {
    if (row[0] <= last || !isTime(row[0]) || !poseOfRow(row, 1)) {
      ++skipped["groundtruth.txt: out of order, or no pose"];
      continue;
    }
    last = row[0];
    char line[256];
    std::snprintf(line, sizeof line, "%.6f %.9g %.9g %.9g %.9g %.9g %.9g %.9g\n", row[0], row[1], row[2],
                  row[3], row[4], row[5], row[6], row[7]);
    text += line;
  }
  return text;
}

ImportInputs inputsIn(const fs::path& folder, const Plan& plan) {
  ImportInputs inputs{folder, {}};
  for (const char* name :
       {"color.txt", "aligned_depth.txt", "sensors.yaml", "trans_matrix.yaml", "odom.txt", "groundtruth.txt"})
    inputs.files.push_back(folder / name);
  for (const auto& [color, depth] : plan.pairs)
    inputs.files.insert(inputs.files.end(),
                        {folder / plan.color[color].file, folder / plan.depth[depth].file});
  return inputs;
}

}  // namespace
}  // namespace openloris

OpenlorisImportResult importOpenloris(const std::filesystem::path& folder,
                                      const std::filesystem::path& rawlog,
                                      const OpenlorisImportOptions& options,
                                      const std::function<void(double)>& progress) {
  if (!std::filesystem::is_directory(folder)) throw InputError(folder.string() + ": no such folder");
  for (const auto& [label, pose] : options.sensor_poses)
    if (label != openloris::kLabel)
      throw ConfigError("--pose " + label + ": the sensor is " + openloris::kLabel);
  OpenlorisImportResult result;
  openloris::Plan plan;
  openloris::planImages(folder, options, plan, result.warnings);
  openloris::planTables(folder, plan, result.warnings);
  openloris::checkClocks(plan, result.warnings);
  const ImportPlaces places = placesOf(rawlog);
  const ImportInputs inputs = openloris::inputsIn(folder, plan);
  checkPlaces(places, inputs, options.external_images);
  if (plan.pairs.empty() && plan.odometry.rows.empty())
    throw InputError(
        folder.string() + ": nothing in it can be imported" +
        (result.warnings.empty() ? ": no pair of images, no odometry" : "; " + result.warnings.front()));
  ImportOutput output(places, options.external_images);
  const EmbeddedImages embedded(options.jpeg_quality);
  OrderedRecords ordered(openloris::kWindowOfRecords_s,
                         [&](const mrpt::obs::CObservation& record) { output.rawlog().write(record); });
  const auto truth = openloris::truthText(plan.truth, result.skipped);
  openloris::SequenceRecords records(folder, std::move(plan), options, output, ordered);
  records.convert(progress);
  ordered.finish();
  result.written = ordered.written();
  result.skipped.insert(records.skipped().begin(), records.skipped().end());
  if (result.written.empty())
    throw InputError(folder.string() + ": no record can be made of it" +
                     (result.skipped.empty() ? "" : "; " + result.skipped.begin()->first));
  if (!truth.empty()) {
    result.ground_truth = places.ground_truth;
    output.setGroundTruth(truth, TruthOf::kRobot);
  }
  for (const auto& removed : output.commit(inputs))
    result.warnings.push_back(removed.string() + " of the former import was removed: this one has none");
  return result;
}

}  // namespace roomgraph
