// SPDX-License-Identifier: BSD-3-Clause
// Choice of a session, and the records and the ground truth of its nodes.
#include "roomgraph/imports/rtabmap_import.h"

#include <mrpt/core/Clock.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <set>

#include "ordered_records.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/suggest.h"
#include "roomgraph/datasets/import_images.h"
#include "roomgraph/datasets/import_output.h"
#include "roomgraph/datasets/picture_decoding.h"
#include "roomgraph/datasets/sqlite_reader.h"
#include "roomgraph/observations/mrpt_camera.h"
#include "rtabmap_blobs.h"

namespace roomgraph {
namespace rtabmap {
namespace {

constexpr double kLatest_s = 7'258'118'400;  // 2200-01-01
constexpr double kHeld_m = 0.1;    // a camera lower than that over the robot's origin is taken for handheld
constexpr float kViewRangeM = 10;  // for viewers only
constexpr const char* kComplaint = "is no database of RTAB-Map, or damaged";

struct MapNode {
  std::int64_t id = 0;
  int session = 0;
  double t = 0;
  std::optional<Pose3> pose, truth;
};

Version readVersion(SqliteReader& database, const std::filesystem::path& file, std::string& text) {
  database.ask("SELECT version FROM Admin");
  if (database.step() != SqliteReader::Step::kRow) database.fail();
  text = database.text(0);
  const auto version = versionOf(text);
  if (!version) throw InputError(file.string() + ": its version '" + text + "' is none");
  if (*version < Version{0, 11, 2})
    throw InputError(file.string() + ": is of version " + text +
                     "; before 0.11.2 is not read: rtabmap-reprocess of RTAB-Map converts it");
  return *version;
}

// In order of time, those without a time last.
std::vector<MapNode> readNodes(SqliteReader& database, RtabmapImportResult& result) {
  database.ask("SELECT id, map_id, stamp, pose, ground_truth_pose FROM Node ORDER BY id");
  std::vector<MapNode> nodes;
  auto state = SqliteReader::Step::kDone;
  while ((state = database.step()) == SqliteReader::Step::kRow) {
    MapNode node{database.integer(0), static_cast<int>(database.integer(1)), database.real(2),
                 transformOf(database.blob(3)), transformOf(database.blob(4))};
    ++result.sessions[node.session];
    nodes.push_back(node);
  }
  if (state == SqliteReader::Step::kFailed) {
    if (nodes.empty()) database.fail();
    result.warnings.push_back("reading of the nodes ended early (" + database.cause() + ") after " +
                              std::to_string(nodes.size()) + "; these are used");
  }
  std::stable_sort(nodes.begin(), nodes.end(), [](const auto& a, const auto& b) { return a.t < b.t; });
  return nodes;
}

int chooseSession(const RtabmapImportOptions& options, const std::filesystem::path& file,
                  RtabmapImportResult& result) {
  if (result.sessions.empty()) throw InputError(file.string() + ": has no nodes");
  std::vector<std::string> names;
  int most = result.sessions.begin()->first;
  for (const auto& [session, count] : result.sessions) {
    names.push_back(std::to_string(session) + " (" + std::to_string(count) + " nodes)");
    if (count > result.sessions.at(most)) most = session;
  }
  if (options.session && !result.sessions.contains(*options.session))
    throw ConfigError(file.string() + ": has no session " + std::to_string(*options.session) +
                      "; there is: " + join(names));
  if (!options.session && names.size() > 1)
    result.warnings.push_back("has several sessions: " + join(names) +
                              "; the one with most nodes is imported (--session)");
  return options.session.value_or(most);
}

// On one floor, whatever its height.
bool staysOnFloor(const std::vector<MapNode>& nodes) {
  constexpr double kHeight_m = 0.05, kTilt = 2 * 0.017453292519943295;
  std::optional<double> height;
  for (const auto& node : nodes) {
    if (!node.pose) continue;
    if (!height) height = node.pose->translation().z();
    if (std::abs(node.pose->translation().z() - *height) > kHeight_m ||
        std::acos(std::clamp(node.pose->linear()(2, 2), -1., 1.)) > kTilt)
      return false;
  }
  return height.has_value();
}

std::string truthLine(double t, const Pose3& pose) {
  const Eigen::Quaterniond q(pose.linear());
  const auto p = pose.translation();
  char text[256];
  std::snprintf(text, sizeof text, "%.6f %.9g %.9g %.9g %.9g %.9g %.9g %.9g\n", t, p.x(), p.y(), p.z(), q.x(),
                q.y(), q.z(), q.w());
  return text;
}

/// Records of nodes. Owns what changes meanwhile: tallies, and the place of the camera.
class NodeRecords {
 public:
  using Push = std::function<void(mrpt::obs::CObservation::Ptr, const std::vector<std::uint8_t>& picture)>;
  NodeRecords(Version version, const RtabmapImportOptions& options, Push push)
      : version_(version), options_(options), push_(std::move(push)) {}

  void takeOdometry(const MapNode& node) {
    if (!node.pose) return skip("pose: there is none");
    const Pose2 pose = planarPart(*node.pose);
    auto odometry = mrpt::obs::CObservationOdometry::Create();
    odometry->odometry = {pose.x, pose.y, pose.yaw};
    finish(odometry, node, "ODOMETRY", {});
  }

  void takeImages(const MapNode& node, Blob image, Blob depth, Blob calibration) {
    if (image.empty() && depth.empty()) return;
    const auto cameras = camerasOf(calibration, version_);
    if (!cameras) return skip("images: " + cameras.reason());
    if (image.empty() || depth.empty()) return skip(image.empty() ? "images: no colour" : "images: no depth");
    const auto color = decodePicture(image);
    if (!color) return skip("image: " + color.reason());
    const auto metric = depthOf(depth);
    if (!metric) return skip("depth: " + metric.reason());
    many_cameras_ = std::max(many_cameras_, cameras->size());
    auto record = mrpt::obs::CObservation3DRangeScan::Create();
    const auto problem =
        fill(*record, firstOf(*color, cameras->size()), firstOf(*metric, cameras->size()), cameras->front());
    if (!problem.empty()) return skip("images: " + problem);
    robot_from_optical_ = cameras->front().robot_from_optical;
    finish(record, node, "RGBD",
           cameras->size() == 1 ? std::vector<std::uint8_t>(image.begin(), image.end())
                                : std::vector<std::uint8_t>());
  }

  void takeScan(const MapNode& node, Blob scan, Blob info) {
    if (scan.empty()) return;
    auto record = scanOf(scan, info, version_);
    if (!record) return skip("scan: " + record.reason());
    finish(*record, node, "LASER", {});
  }

  void skip(const std::string& reason) { ++skipped_[reason]; }
  const std::map<std::string, int>& skipped() const { return skipped_; }
  std::size_t cameras() const { return many_cameras_; }
  /// Of the last image.
  const std::optional<Pose3>& robotFromOptical() const { return robot_from_optical_; }

 private:
  static Outcome<cv::Mat> decodePicture(Blob blob) {
    auto image = roomgraph::decodePicture(blob, cv::IMREAD_ANYCOLOR);
    if (image && image->type() != CV_8UC3 && image->type() != CV_8UC1)
      return Outcome<cv::Mat>::failure("is not of 8 bit");
    return image;
  }
  static cv::Mat firstOf(const cv::Mat& side_by_side, std::size_t count) {
    return side_by_side(cv::Rect(0, 0, side_by_side.cols / static_cast<int>(count), side_by_side.rows));
  }
  static std::string sizeOf(int width, int height) {
    return std::to_string(width) + "x" + std::to_string(height);
  }

  // Empty, or what is wrong.
  static std::string fill(mrpt::obs::CObservation3DRangeScan& record, const cv::Mat& color,
                          const cv::Mat& depth, const CameraBlob& blob) {
    PinholeCamera camera = blob.camera;
    if (camera.width == 0) camera.width = color.cols;
    if (camera.height == 0) camera.height = color.rows;
    if (color.cols != camera.width || color.rows != camera.height)
      return "image is " + sizeOf(color.cols, color.rows) + " px, its camera " +
             sizeOf(camera.width, camera.height);
    // A smaller depth image is of the same view.
    const double scale = static_cast<double>(depth.cols) / camera.width;
    if (std::abs(scale * camera.height - depth.rows) > 1)
      return "depth of " + sizeOf(depth.cols, depth.rows) + " px does not fit the image";
    PinholeCamera depth_camera = camera;
    depth_camera.width = depth.cols;
    depth_camera.height = depth.rows;
    for (double* value : {&depth_camera.fx, &depth_camera.fy, &depth_camera.cx, &depth_camera.cy})
      *value *= scale;
    record.hasIntensityImage = true;
    record.intensityImage = mrpt::img::CImage(color, mrpt::img::DEEP_COPY);
    setDepth(record, depth);
    record.maxRange = kViewRangeM;
    record.cameraParamsIntensity = toMrpt(camera);
    record.cameraParams = toMrpt(depth_camera);
    Pose3 forward_from_optical = Pose3::Identity();
    forward_from_optical.linear() = bodyFromOptical();
    record.sensorPose = toMrpt(blob.robot_from_optical * forward_from_optical.inverse());
    return "";
  }

  void finish(const mrpt::obs::CObservation::Ptr& record, const MapNode& node, const std::string& label,
              const std::vector<std::uint8_t>& picture) {
    record->timestamp = mrpt::Clock::fromDouble(node.t);
    record->sensorLabel = label;
    const auto given = options_.sensor_poses.find(label);
    if (given != options_.sensor_poses.end()) record->setSensorPose(toMrpt(given->second));
    push_(record, picture);
  }

  Version version_;
  const RtabmapImportOptions& options_;
  Push push_;
  std::map<std::string, int> skipped_;
  std::size_t many_cameras_ = 0;
  std::optional<Pose3> robot_from_optical_;
};

struct Reading {
  std::vector<MapNode> nodes;  ///< of the session
  bool odometry = false;
};

void convert(SqliteReader& database, const Reading& reading, NodeRecords& records,
             std::vector<std::string>& warnings, const std::function<void(double)>& progress) {
  std::set<double> stamps;
  for (std::size_t i = 0; i < reading.nodes.size(); ++i) {
    const auto& node = reading.nodes[i];
    if (progress) progress(static_cast<double>(i) / static_cast<double>(reading.nodes.size()));
    if (!(node.t > 0 && node.t < kLatest_s)) {
      records.skip("node: time is not between 1970 and 2200");
      continue;
    }
    if (!stamps.insert(node.t).second) {
      records.skip("node: same time as another");
      continue;
    }
    if (reading.odometry) records.takeOdometry(node);
    database.ask("SELECT image, depth, calibration, scan, scan_info FROM Data WHERE id = " +
                 std::to_string(node.id));
    const auto state = database.step();
    if (state == SqliteReader::Step::kFailed) {
      if (warnings.empty() || warnings.back().find("node ") != 0)
        warnings.push_back("node " + std::to_string(node.id) +
                           ": its data cannot be read: " + database.cause());
      records.skip("data: damaged");
    }
    if (state != SqliteReader::Step::kRow) continue;
    records.takeImages(node, database.blob(0), database.blob(1), database.blob(2));
    records.takeScan(node, database.blob(3), database.blob(4));
  }
}

void planOdometry(const RtabmapImportOptions& options, Reading& reading, std::vector<std::string>& warnings) {
  const bool any = std::any_of(reading.nodes.begin(), reading.nodes.end(),
                               [](const auto& node) { return node.pose.has_value(); });
  reading.odometry = any && options.odometry != NodeOdometry::kNone;
  if (!reading.odometry || options.odometry == NodeOdometry::kPlanar || staysOnFloor(reading.nodes)) return;
  reading.odometry = false;
  warnings.push_back(
      "poses of the nodes do not stay on a floor: no odometry is made of them (--odometry planar does)");
}

// Ground truth of the robot, or of the camera in a hand.
void writeTruth(const Reading& reading, const NodeRecords& records, const std::filesystem::path& place,
                ImportOutput& output, RtabmapImportResult& result) {
  const auto& camera = records.robotFromOptical();
  const bool held = camera && std::abs(camera->translation().z()) <= kHeld_m && !reading.odometry;
  std::string text;
  double last = 0;
  for (const auto& node : reading.nodes) {
    if (!node.truth || !(node.t > last && node.t < kLatest_s)) continue;
    last = node.t;
    text += truthLine(node.t, held ? *node.truth * *camera : *node.truth);
  }
  if (text.empty()) return;
  output.setGroundTruth(text, held ? TruthOf::kCamera : TruthOf::kRobot);
  result.ground_truth = place;
  result.truth =
      held ? "ground_truth_pose, of the camera (optical frame)" : "ground_truth_pose, of the robot";
}

}  // namespace
}  // namespace rtabmap

RtabmapImportResult importRtabmap(const std::filesystem::path& file, const std::filesystem::path& rawlog,
                                  const RtabmapImportOptions& options,
                                  const std::function<void(double)>& progress) {
  const ImportPlaces places = placesOf(rawlog);
  const ImportInputs inputs{file, {file}};
  checkPlaces(places, inputs, options.external_images);
  if (!std::filesystem::is_regular_file(file)) throw InputError(file.string() + ": no such file");
  for (const auto& [label, pose] : options.sensor_poses)
    if (label != "RGBD" && label != "LASER")
      throw ConfigError("--pose " + label + ": the sensors are RGBD and LASER");
  SqliteReader database(file, rtabmap::kComplaint);
  RtabmapImportResult result;
  const auto version = rtabmap::readVersion(database, file, result.version);
  rtabmap::Reading reading{rtabmap::readNodes(database, result)};
  result.session = rtabmap::chooseSession(options, file, result);
  std::erase_if(reading.nodes, [&](const auto& node) { return node.session != result.session; });
  rtabmap::planOdometry(options, reading, result.warnings);
  ImportOutput output(places, options.external_images);
  const EmbeddedImages embedded(options.jpeg_quality);
  OrderedRecords ordered(0, [&](const mrpt::obs::CObservation& record) { output.rawlog().write(record); });
  rtabmap::NodeRecords records(
      version, options, [&](const auto& record, const std::vector<std::uint8_t>& picture) {
        auto images = std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(record);
        if (images && options.external_images) storeOutside(*images, picture, output);
        ordered.push(record);
      });
  rtabmap::convert(database, reading, records, result.warnings, progress);
  ordered.finish();
  result.written = ordered.written();
  result.skipped = records.skipped();
  if (result.written.empty())
    throw InputError(file.string() + ": no record can be made of it" +
                     (result.skipped.empty() ? "" : "; " + result.skipped.begin()->first));
  if (records.cameras() > 1)
    result.warnings.push_back("has " + std::to_string(records.cameras()) +
                              " cameras side by side: the first is imported");
  rtabmap::writeTruth(reading, records, places.ground_truth, output, result);
  for (const auto& removed : output.commit(inputs))
    result.warnings.push_back(removed.string() + " of the former import was removed: this one has none");
  return result;
}

}  // namespace roomgraph
