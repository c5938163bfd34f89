// SPDX-License-Identifier: BSD-3-Clause
// Scan matching, visual odometry and plane search over the records of a rawlog.
#include "read_evidence.h"

#include <mrpt/obs/CObservation3DRangeScan.h>

#include <algorithm>
#include <memory>

#include "board_view.h"
#include "depth_view.h"
#include "roomgraph/core/class_registry.h"
#include "roomgraph/core/config.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/datasets/observation_reader.h"
#include "roomgraph/lidar/register_classes.h"
#include "roomgraph/lidar/scan_matcher.h"
#include "roomgraph/proposals/ground_detector.h"
#include "roomgraph/proposals/register_classes.h"
#include "roomgraph/tracking/register_classes.h"
#include "roomgraph/tracking/rgbd_odometry.h"
#include "scan_walls.h"

namespace roomgraph {
namespace {

constexpr double kViewSpacing_s = 0.2, kViewSpacing_m = 0.03, kViewSpacing_rad = 0.015;
constexpr double kStepLeast_s = 0.25, kStepMost_s = 0.9;
constexpr double kStepLeast_m = 0.02, kStepLeast_rad = 0.02;  // less is standing still
constexpr double kBand_m = 0.5;                               // of heights around the lidar's
constexpr double kSamePose = 1e-4;

// Walls alone place a scan: a movement that was expected would carry over its own lag. The floor may be far
// from where the recorded pose has it.
const char* const kStageSettings =
    "[lidar]\nprior_per_m2 = 0\nprior_per_rad2 = 0\nled = false\n"
    "[ground]\nmax_angle_error_rad = 0.2\nmax_height_error_m = 0.35\n";

template <class Interface>
std::shared_ptr<Interface> makeStage(const std::string& name, const std::string& section) {
  auto stage = createStage<Interface>(name, "calibrate");
  Config::fromText(kStageSettings).read(section, *stage);
  stage->prepare();
  return stage;
}

class EvidenceReader {
 public:
  EvidenceReader(const std::filesystem::path& file, const std::optional<Board>& board, SensorsBefore& sensors)
      : file_(file), board_(board), sensors_(sensors) {}

  void add(const Scan& scan) {
    keep(sensors_.robot_from_lidar, scan.robot_from_lidar, sensors_.lidar_label, scan.sensor_label, "lidar");
    const auto match = matcher_->match(scan, std::nullopt);
    evidence_.scans.push_back({scan.t, findScanWalls(horizontalReturns(scan))});
    if (!match.matched) return;
    if (evidence_.lidar.empty() || match.segment != lidar_segment_) evidence_.lidar.emplace_back();
    lidar_segment_ = match.segment;
    lidar_now_ = match.odom_from_robot;
    evidence_.lidar.back().add(scan.t, match.odom_from_robot * planarPart(scan.robot_from_lidar));
  }

  void add(const OdometryReading& reading) {
    sensors_.wheels = true;
    if (evidence_.wheels.empty()) evidence_.wheels.emplace_back();
    evidence_.wheels.back().add(reading.t, reading.odom_from_robot);
    wheels_now_ = reading.odom_from_robot;
  }

  void add(const Frame& frame) {
    keep(sensors_.robot_from_camera, frame.robot_from_camera, sensors_.camera_label, frame.sensor_label,
         "camera");
    if (board_ && isNewView(frame.t, board_seen_)) addBoard(frame);
    if (!frame.hasDepth()) return;
    sensors_.depth = true;
    tracker_->track(frame, {});
    if (const auto depth = medianDepth(frame)) depths_.emplace_back(frame.t, *depth);
    if (isNewView(frame.t, view_seen_)) addView(frame);
  }

  void add(const std::shared_ptr<CObservationDetections>&) {}

  RecordingEvidence finish() {
    if (!depths_.empty() && !evidence_.lidar.empty()) addSteps(tracker_->trajectory());
    std::erase_if(evidence_.lidar, [](const PlanarPath& path) { return path.size() < 3; });
    std::erase_if(evidence_.wheels, [](const PlanarPath& path) { return path.size() < 3; });
    for (auto* paths : {&evidence_.lidar, &evidence_.wheels})
      for (PlanarPath& path : *paths) path.smooth();
    return std::move(evidence_);
  }

 private:
  void keep(std::optional<Pose3>& known, const Pose3& pose, std::string& known_label,
            const std::string& label, const std::string& kind) {
    if (!known) {
      known = pose;
      known_label = label;
    }
    if (label != known_label)
      throw InputError(file_.string() + ": its " + kind + " is '" + label + "', that of another recording '" +
                       known_label + "'");
    if (!pose.isApprox(*known, kSamePose))
      throw InputError(file_.string() + ": the pose of the " + kind + " '" + label +
                       "' on the robot changes: only sensors that are fixed to the robot can be calibrated");
  }

  // When and where something was looked at last.
  struct Looked {
    std::optional<double> t;
    Pose2 lidar, wheels;
  };

  // Where the robot stands still, one view says what many say.
  bool isNewView(double t, Looked& last) const {
    if (last.t && t < *last.t + kViewSpacing_s) return false;
    const auto moved = [](const Pose2& before, const Pose2& now) {
      const Pose2 step = before.inverse() * now;
      return std::hypot(step.x, step.y) > kViewSpacing_m || std::abs(step.yaw) > kViewSpacing_rad;
    };
    const bool known = !evidence_.lidar.empty() || !evidence_.wheels.empty();
    if (last.t && known && !moved(last.lidar, lidar_now_) && !moved(last.wheels, wheels_now_)) return false;
    last = {t, lidar_now_, wheels_now_};
    return true;
  }

  void addView(const Frame& frame) {
    const auto ground = ground_->detect(frame, groundInCamera(frame.robot_from_camera));
    std::optional<HeightBand> band;
    if (sensors_.robot_from_lidar) {
      const double z = sensors_.robot_from_lidar->translation().z();
      band = {z - kBand_m, z + kBand_m};
    }
    evidence_.views.push_back(
        makeDepthView(frame, ground ? std::optional<Plane>(ground->plane) : std::nullopt, band));
  }

  void addBoard(const Frame& frame) {
    const auto view = findBoard(frame, *board_);
    if (!view) return;
    sensors_.board = true;
    sensors_.board_depth = sensors_.board_depth || view->depth;
    evidence_.boards.push_back(*view);
  }

  void addSteps(const Trajectory& camera) {
    std::size_t a = 0;
    for (std::size_t b = 1; b < camera.size(); ++b) {
      const auto &from = camera.poses()[a], &to = camera.poses()[b];
      if (to.t - from.t < kStepLeast_s && camera.segment(a) == camera.segment(b)) continue;
      const Pose3 moved = from.pose.inverse() * to.pose;
      if (camera.segment(a) == camera.segment(b) && to.t - from.t <= kStepMost_s &&
          (moved.translation().norm() > kStepLeast_m || rotationAngle(moved) > kStepLeast_rad)) {
        const auto depth = std::lower_bound(depths_.begin(), depths_.end(), std::make_pair(from.t, 0.0));
        evidence_.steps.push_back({from.t, to.t, moved, depth == depths_.end() ? 2 : depth->second});
      }
      a = b;
    }
  }

  const std::filesystem::path& file_;
  const std::optional<Board>& board_;
  SensorsBefore& sensors_;
  RecordingEvidence evidence_;
  std::shared_ptr<ScanMatcher> matcher_ = makeStage<ScanMatcher>("SubmapScanMatcher", "lidar");
  std::shared_ptr<RgbdOdometry> tracker_ = makeStage<RgbdOdometry>("FeatureOdometry", "tracking");
  std::shared_ptr<GroundDetector> ground_ = makeStage<GroundDetector>("DepthGroundDetector", "ground");
  int lidar_segment_ = 0;
  Pose2 lidar_now_, wheels_now_;
  Looked view_seen_, board_seen_;
  std::vector<std::pair<double, double>> depths_;  ///< time, median depth
};

// Of the records themselves: a frame has the place of its colour camera only.
Pose3 depthPoseOf(const std::filesystem::path& file, const std::string& label) {
  ObservationReader reader(file);
  while (const auto observation = reader.next())
    if (const auto images = std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(observation))
      if (images->sensorLabel == label) return toPose3(images->sensorPose);
  return Pose3::Identity();
}

}  // namespace

RecordingEvidence readEvidence(const std::filesystem::path& recording, const ReadOptions& read,
                               const std::optional<Board>& board, SensorsBefore& sensors,
                               const std::function<void(double)>& progress) {
  lidar::registerClasses();
  tracking::registerClasses();
  proposals::registerClasses();
  RawlogReader reader(recording, read);
  EvidenceReader evidence(recording, board, sensors);
  while (auto record = reader.next()) {
    std::visit([&](const auto& value) { evidence.add(value); }, *record);
    if (progress) progress(reader.progress());
  }
  if (sensors.robot_from_camera) {
    const auto given = read.sensor_poses.find(sensors.camera_label);
    sensors.robot_from_depth =
        given != read.sensor_poses.end() ? given->second : depthPoseOf(recording, sensors.camera_label);
  }
  return evidence.finish();
}

}  // namespace roomgraph
