// SPDX-License-Identifier: BSD-3-Clause
// PNG images, lists and camera file of a TUM folder, written under a temporary name.
#include "roomgraph/datasets/tum_export.h"

#include <mrpt/core/Clock.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <optional>

#include "frame_conversion.h"
#include "image_folder.h"
#include "lens_removal.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"
#include "roomgraph/core/suggest.h"
#include "roomgraph/datasets/observation_reader.h"
#include "roomgraph/datasets/truth_file.h"
#include "roomgraph/observations/mounting.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;
using mrpt::obs::CObservation3DRangeScan;

constexpr double kScaleOfRegistered = 5000;  // the benchmark's own
constexpr double kSameMount = 1e-4;

struct ImagePair {
  cv::Mat color, depth;  ///< CV_8UC3 or CV_8UC1; CV_16UC1
  PinholeCamera camera;
  double depth_scale = 0;
  bool registered_here = false;
  std::optional<Pose3> robot_from_camera = std::nullopt;  ///< x ahead; none: that of the record
};

// A folder under construction, removed unless it was put into its place.
class PendingFolder {
 public:
  explicit PendingFolder(fs::path place)
      : place_(std::move(place)), pending_(place_.string() + ".unfinished") {
    std::error_code error;
    if (fs::exists(place_, error) && (!fs::is_directory(place_, error) || !fs::is_empty(place_, error)))
      throw ConfigError(place_.string() + ": is there already and not an empty folder; name another one");
    fs::remove_all(pending_, error);
    fs::create_directories(pending_ / "rgb", error);
    if (!error) fs::create_directories(pending_ / "depth", error);
    if (error) throw RunError("cannot make the folder " + pending_.string() + ": " + error.message());
  }
  ~PendingFolder() {
    std::error_code ignored;
    if (!pending_.empty()) fs::remove_all(pending_, ignored);
  }
  PendingFolder(const PendingFolder&) = delete;
  PendingFolder& operator=(const PendingFolder&) = delete;
  fs::path file(const std::string& name) const { return pending_ / name; }
  void commit() {
    std::error_code error;
    fs::remove(place_, error);  // an empty one
    fs::rename(pending_, place_, error);
    if (error) throw RunError("cannot write " + place_.string() + ": " + error.message());
    pending_.clear();
  }

 private:
  fs::path place_, pending_;
};

void writePng(const fs::path& file, const cv::Mat& image) {
  std::vector<std::uint8_t> bytes;
  if (!cv::imencode(".png", image, bytes))
    throw RunError("cannot write " + file.string() + ": no PNG encoder");
  OutputFile out(file);
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  out.finish();
}

// As recorded; the arrays live as long as the observation.
ImagePair pairAsItIs(CObservation3DRangeScan& record) {
  ImagePair pair;
  pair.color = record.intensityImage.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY);
  auto& ranges = record.rangeImage;
  pair.depth =
      cv::Mat(static_cast<int>(ranges.rows()), static_cast<int>(ranges.cols()), CV_16UC1, ranges.data());
  pair.camera = cameraForImage(record.cameraParamsIntensity, pair.color.cols, pair.color.rows);
  const double scale = 1.0 / record.rangeUnits;  // of a float: 0.001f gives 999.99995
  pair.depth_scale = std::abs(scale - std::round(scale)) < 1e-3 ? std::round(scale) : scale;
  return pair;
}

// 16 bits; what is farther than they reach is not known.
cv::Mat inUnits(const cv::Mat& depth, double scale) {
  cv::Mat scaled, out;
  depth.convertTo(scaled, CV_64F, scale);
  scaled.setTo(0, scaled > std::numeric_limits<std::uint16_t>::max());
  scaled.convertTo(out, CV_16U);
  return out;
}

Outcome<ImagePair> pairOf(CObservation3DRangeScan& record, const ObservationReader& reader) {
  const bool simple_lens = !otherLensOf(record.cameraParamsIntensity) && !otherLensOf(record.cameraParams);
  if (simple_lens && ObservationReader::isRegistered(record) && record.range_is_depth && record.rangeUnits > 0)
    return pairAsItIs(record);
  const auto frame = reader.frameOf(record);
  if (!frame) return Outcome<ImagePair>::failure(frame.reason());
  if (frame->color.empty() || frame->depth.empty())
    return Outcome<ImagePair>::failure("colour or depth image missing");
  Pose3 robot_from_camera = frame->robot_from_camera;  // of the colour image, whose pixels the depth has now
  robot_from_camera.linear() = robot_from_camera.linear() * bodyFromOptical().transpose();
  ImagePair pair{frame->color, {}, frame->camera, kScaleOfRegistered, true, robot_from_camera};
  pair.depth = inUnits(frame->depth, kScaleOfRegistered);
  return pair;
}

// What an importer needs besides the images.
std::string cameraJson(const PinholeCamera& camera, double depth_scale) {
  const nlohmann::ordered_json json{{"width", camera.width},
                                    {"height", camera.height},
                                    {"fx", camera.fx},
                                    {"fy", camera.fy},
                                    {"cx", camera.cx},
                                    {"cy", camera.cy},
                                    {"distortion", camera.distortion},
                                    {"depth_scale", depth_scale}};
  return json.dump(2) + "\n";
}

class TumFolderWriter {
 public:
  TumFolderWriter(const fs::path& folder, std::string label) : folder_(folder) {
    result_.label = std::move(label);
  }

  void write(CObservation3DRangeScan& record, const ObservationReader& reader) {
    if (result_.label.empty()) result_.label = record.sensorLabel;
    if (record.sensorLabel != result_.label)
      return leaveOut("of another camera, '" + record.sensorLabel + "'");
    auto pair = pairOf(record, reader);
    if (!pair) return leaveOut(pair.reason());
    if (result_.written == 0) begin(*pair, record);
    if (!(pair->camera == result_.camera)) return leaveOut("its camera is not that of the first image");
    camera_moves_ = camera_moves_ || !mountOf(*pair, record).isApprox(result_.robot_from_camera, kSameMount);
    if (pair->depth_scale != depth_scale_)
      pair->depth = inUnits(pair->depth, depth_scale_ / pair->depth_scale);
    char stamp[48];
    std::snprintf(stamp, sizeof stamp, "%.9f", mrpt::Clock::toDouble(record.timestamp));
    const std::string color = std::string("rgb/") + stamp + ".png",
                      depth = std::string("depth/") + stamp + ".png";
    writePng(folder_.file(color), pair->color);
    writePng(folder_.file(depth), pair->depth);
    rgb_ += stamp + (" " + color) + "\n";
    depth_ += stamp + (" " + depth) + "\n";
    both_ += stamp + (" " + color + " ") + stamp + " " + depth + "\n";
    ++result_.written;
    result_.registered += pair->registered_here ? 1 : 0;
  }

  TumExportResult finish(const fs::path& ground_truth) {
    writeFileAtomically(folder_.file("rgb.txt"), rgb_);
    writeFileAtomically(folder_.file("depth.txt"), depth_);
    writeFileAtomically(folder_.file("associations.txt"), both_);
    writeFileAtomically(folder_.file("camera.json"), cameraJson(result_.camera, depth_scale_));
    writeTruth(ground_truth);
    folder_.commit();
    for (const auto& [reason, count] : left_out_)
      result_.warnings.push_back(std::to_string(count) + " records left out: " + reason);
    return result_;
  }
  const TumExportResult& result() const { return result_; }

 private:
  // In that format it is the camera's.
  void writeTruth(const fs::path& ground_truth) {
    const TruthOf whose = whoseTruth(ground_truth).value_or(isMounted(result_.robot_from_camera) ? TruthOf::kRobot : TruthOf::kCamera);
    if (whose == TruthOf::kCamera) {
      std::error_code error;
      result_.ground_truth = fs::copy_file(ground_truth, folder_.file("groundtruth.txt"), error);
      return;
    }
    if (!fs::is_regular_file(ground_truth)) return;
    if (camera_moves_) {
      result_.warnings.push_back(ground_truth.string() + ": left out: it is the robot's, on which this camera moves");
      return;
    }
    Pose3 robot_from_optical = result_.robot_from_camera;
    robot_from_optical.linear() = robot_from_optical.linear() * bodyFromOptical();
    writeFileAtomically(folder_.file("groundtruth.txt"),
                        truthComment(TruthOf::kCamera) + truthOnRobot(ground_truth, robot_from_optical));
    result_.ground_truth = true;
  }

  static Pose3 mountOf(const ImagePair& pair, const CObservation3DRangeScan& record) {
    return pair.robot_from_camera.value_or(toPose3(record.sensorPose));
  }
  void begin(const ImagePair& pair, const CObservation3DRangeScan& record) {
    result_.camera = pair.camera;
    result_.robot_from_camera = mountOf(pair, record);
    depth_scale_ = pair.depth_scale;
  }
  void leaveOut(const std::string& reason) {
    ++result_.left_out;
    ++left_out_[reason];
  }

  PendingFolder folder_;
  TumExportResult result_;
  double depth_scale_ = 0;
  bool camera_moves_ = false;  ///< on the robot
  std::string rgb_, depth_, both_;
  std::map<std::string, int> left_out_;
};

}  // namespace

TumExportResult exportTum(const fs::path& rawlog, const fs::path& folder, const std::string& label,
                          const std::function<void(double)>& progress) {
  ObservationReader reader(rawlog);
  TumFolderWriter writer(folder, label);
  std::map<std::string, int> labels;
  while (const auto observation = reader.next()) {
    if (const auto images = std::dynamic_pointer_cast<CObservation3DRangeScan>(observation)) {
      ++labels[images->sensorLabel];
      writer.write(*images, reader);
    }
    if (progress) progress(reader.progress());
  }
  if (!label.empty() && !labels.contains(label)) {
    std::vector<std::string> known;
    for (const auto& [name, count] : labels) known.push_back("'" + name + "'");
    throw ConfigError(rawlog.string() + ": no RGB-D camera '" + label + "'; there is: " + join(known));
  }
  if (writer.result().written == 0)
    throw InputError(rawlog.string() + ": no pair of colour and depth images in it");
  auto result = writer.finish(withoutEndings(rawlog).string() + ".groundtruth.txt");
  if (!reader.truncation().empty()) result.warnings.push_back(reader.truncation());
  for (const auto& [reason, count] : reader.skipped())
    result.warnings.push_back(std::to_string(count) + " records skipped: " + reason);
  return result;
}

}  // namespace roomgraph
