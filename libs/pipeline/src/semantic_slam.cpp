// SPDX-License-Identifier: BSD-3-Clause
// Order of the stages per record, levelling, map anchoring, and final refinement.
#include "roomgraph/pipeline/semantic_slam.h"

#include <cmath>
#include <limits>

#include "roomgraph/core/errors.h"
#include "roomgraph/lidar/dynamic_return_filter.h"

namespace roomgraph {
namespace {

constexpr double kPeopleMaxAge_s = 0.3;  // a person walks .4 m in this time
constexpr double kMovementHorizon_s = 0.15;
constexpr int kMaxDescents = 5;
constexpr double kPersonMargin_m = 0.15, kPersonDepth_m = 0.6;

// A sensor on a robot has a place on it; a handheld camera has none.
bool isMounted(const Frame& frame) {
  return frame.robot_from_camera.translation().z() > 0.1;
}

}  // namespace

SemanticSlam::SemanticSlam(std::unique_ptr<Stages> stages)
    : stages_(std::move(stages)),
      front_ends_(*stages_),
      box_tracker_(stages_->detection.tracker, stages_->database),
      estimator_(stages_->backend, front_ends_.motion()),
      objects_(*stages_, estimator_.poses()),
      object_loops_(stages_->object_loops),
      last_frame_t_(-std::numeric_limits<double>::infinity()),
      last_scan_t_(last_frame_t_) {}

void SemanticSlam::process(const Record& record) {
  times_.startRecord(timeOf(record));
  const StepReport report = std::visit([this](const auto& value) { return step(value); }, record);
  for (const auto& sink : sinks_) sink->onStep(report);
}

StepReport SemanticSlam::step(const Frame& frame) {
  StepReport report{.kind = StepReport::Kind::kFrame, .t = frame.t, .frame = frame.id, .image = &frame};
  if (!inOrder(frame.t, last_frame_t_, "frames")) return {};
  ++counts_.frames;
  robot_from_camera_ = frame.robot_from_camera;
  estimator_.measurements().planar |= isMounted(frame);

  const auto detections = detect(frame, report);  // sec. 1.1
  track(frame, report);                           // sec. 4, factor 1
  localize(frame.t);                              // sec. 4, M-step
  propose(frame, detections);                     // sec. 1.2 to 1.D
  mapObjects(frame, report);                      // sec. 3, and sec. 4, E-step

  robot_times_.push_back(frame.t);
  camera_mounts_.emplace_back(frame.t, frame.robot_from_camera);
  report.world_from_robot = estimator_.poses().at(frame.t);
  report.seen = &seen_;
  return report;
}

StepReport SemanticSlam::step(const Scan& scan) {
  StepReport report{.kind = StepReport::Kind::kScan, .t = scan.t};
  if (!stages_->scan_matcher || !inOrder(scan.t, last_scan_t_, "scans")) return {};
  ++counts_.scans;
  estimator_.measurements().planar = true;

  const Scan clean = withoutPeople(scan);  // sec. 5
  const ScanMatch match = matched(clean);
  if (!match.matched) {
    ++counts_.scans_unmatched;
    ++counts_.reasons["lidar: " + match.reason];
    report.note = "scan not matched: " + match.reason;
  } else if (stages_->scan_loop_closer) {
    stages_->scan_loop_closer->add(clean, match);
  }
  stages_->mapper.add(clean);
  localize(scan.t);
  objects_.observe(clean, estimator_.poses().at(scan.t));
  if (map_ && !anchored_) last_scan_ = clean;

  robot_times_.push_back(scan.t);
  report.world_from_robot = estimator_.poses().at(scan.t);
  return report;
}

StepReport SemanticSlam::step(const OdometryReading& reading) {
  if (!stages_->odometry.enabled) return {};
  estimator_.measurements().planar = true;
  ++counts_.odometry;
  if (!front_ends_.add(reading)) {
    ++counts_.reasons["odometry: stamp does not come after the previous one"];
    return {.t = reading.t};
  }
  odometry_times_.push_back(reading.t);
  // Frames and scans say when a pose is wanted; without any, the readings do.
  if (robot_times_.empty()) localize(reading.t);
  return {.t = reading.t};
}

StepReport SemanticSlam::step(const std::shared_ptr<CObservationDetections>& recorded) {
  ++counts_.detections;
  if (stages_->detector) stages_->detector->feed(*recorded);
  return {};
}

bool SemanticSlam::inOrder(double t, double& last, const std::string& source) {
  if (t <= last) {
    ++counts_.reasons[source + ": stamp does not come after the previous one"];
    return false;
  }
  last = t;
  return true;
}

std::vector<Detection> SemanticSlam::detect(const Frame& frame, StepReport& report) {
  if (!stages_->detector || stages_->detector->idle()) return {};
  const auto timing = times_.measure("detection");
  const auto found = stages_->detector->detect(frame);
  report.detector_ran = found.ok();
  if (found) {
    box_tracker_.start(*found, frame);
    report.detections = *found;
  } else {
    ++counts_.reasons["detection: " + found.reason()];
    report.detections = box_tracker_.advance(frame, cameraMovement(frame));
    report.boxes_carried = box_tracker_.active();
    if (!report.boxes_carried) return {};
  }
  people_.clear();
  for (const auto& detection : report.detections) {
    if (stages_->database.moves(detection.class_name)) people_.push_back(detection.box);
  }
  return report.detections;
}

// Since the frame that the box tracker saw last, as far as it is known before this frame is tracked.
std::optional<Pose3> SemanticSlam::cameraMovement(const Frame& frame) const {
  if (!box_tracker_.active()) return std::nullopt;
  const auto moved = front_ends_.motion().movement(box_tracker_.lastTime(), frame.t, kMovementHorizon_s);
  if (!moved) return std::nullopt;
  return frame.robot_from_camera.inverse() * *moved * frame.robot_from_camera;
}

void SemanticSlam::track(const Frame& frame, StepReport& report) {
  if (!stages_->rgbd_odometry) return;
  const auto timing = times_.measure("RGB-D odometry");
  const TrackingResult result = front_ends_.track(frame, people_);
  features_ = result.features;
  if (result.tracked) return;
  ++counts_.frames_lost;
  ++counts_.reasons["tracking: " + result.reason];
  report.note = "not tracked: " + result.reason;
}

ScanMatch SemanticSlam::matched(const Scan& scan) {
  const auto timing = times_.measure("scan matching");
  return front_ends_.match(scan);
}

void SemanticSlam::localize(double t) {
  if (!estimator_.advance(t)) return;
  estimator_.addClosures(front_ends_.takeImageClosures(), objects_);
  if (stages_->scan_loop_closer) {
    const auto timing = times_.measure("scan loop closing");
    estimator_.addClosures(stages_->scan_loop_closer->search(estimator_.poses().trajectory()), objects_);
  }
  {
    const auto timing = times_.measure("object loop closing");
    const auto verify = [this](const RelativePose& proposed) { return front_ends_.verify(proposed); };
    if (const auto closure = object_loops_.search(objects_, estimator_.poses(), verify))
      estimator_.addClosures({*closure}, objects_);
  }
  {
    const auto timing = times_.measure(estimator_.due() ? "whole graph" : "window of poses");
    estimator_.update(objects_);
  }
  anchor();
}

void SemanticSlam::setMap(CSemanticMap map) {
  map_.emplace(std::move(map), stages_->object_loops.constellation);
}

// Looks for the landmarks seen so far in the map given to the run; moves the world there when they are found.
void SemanticSlam::anchor() {
  if (!map_ || anchored_ || estimator_.poses().empty()) return;
  std::vector<Eigen::Vector2d> returns;
  if (last_scan_) {
    const Pose3 world_from_robot = estimator_.poses().at(last_scan_->t);
    for (const auto& point : last_scan_->pointsInRobot())
      returns.push_back((world_from_robot * point).head<2>());
  }
  const auto map_from_world = map_->find(objects_.landmarks().confirmed(), returns);
  if (!map_from_world) return;
  estimator_.transform(toPose3(*map_from_world));
  objects_.moveSince(-std::numeric_limits<double>::infinity(), toPose3(*map_from_world));
  anchored_ = true;
}

void SemanticSlam::propose(const Frame& frame, const std::vector<Detection>& detections) {
  std::optional<Plane> expected;
  if (isMounted(frame)) expected = groundInCamera(frame.robot_from_camera);
  if (levelled_) expected = groundInCamera(estimator_.poses().at(frame.t) * frame.robot_from_camera);
  const auto timing = times_.measure("proposals");
  seen_ = stages_->proposal_generator->generate(frame, detections, expected);
  if (!seen_.ground) {
    ++counts_.reasons["ground: " + seen_.ground_reason];
    return;
  }
  level(frame);
  stages_->mapper.add(frame, seen_.ground->plane);
}

// A handheld camera's world is levelled when the floor is seen for the first time; later sightings become
// factors.
void SemanticSlam::level(const Frame& frame) {
  if (estimator_.measurements().planar || !seen_.ground->from_depth) return;
  const Plane& plane = seen_.ground->plane;
  if (!levelled_) {
    const Pose3 world_from_camera = estimator_.poses().at(frame.t) * frame.robot_from_camera;
    const Pose3 level_from_world = cameraFromGround(plane).inverse() * world_from_camera.inverse();
    const Pose2 first = planarPart(level_from_world * estimator_.poses().nodes().front().world_from_robot);
    estimator_.transform(toPose3(first.inverse()) * level_from_world);
    levelled_ = true;
  }
  const KeyPose& node = estimator_.poses().nodes().back();
  if (node.t != frame.t) return;
  GroundFactor factor{.node = node.id,
                      .normal_in_robot = frame.robot_from_camera.linear() * plane.normal,
                      .sigma_normal_rad = stages_->backend.ground_sigma_rad,
                      .sigma_offset_m = stages_->backend.ground_sigma_m};
  factor.offset_m = plane.offset - factor.normal_in_robot.dot(frame.robot_from_camera.translation());
  estimator_.measurements().grounds.push_back(factor);
}

void SemanticSlam::mapObjects(const Frame& frame, StepReport& report) {
  if (!(report.detector_ran || report.boxes_carried) || !seen_.ground) return;
  const auto timing = times_.measure("selection and association");
  report.decisions = objects_.observe(seen_, frame, features_);
  if (report.detector_ran) objects_.missUnseen(report.decisions, report.detections, frame);
}

// Returns inside the wedge of a person's box, at the person's depth (sec. 5).
Scan SemanticSlam::withoutPeople(const Scan& scan) {
  std::vector<DynamicWedge> wedges;
  for (const auto& proposal : seen_.proposals) {
    if (!stages_->database.moves(proposal.class_name) || std::abs(seen_.t - scan.t) > kPeopleMaxAge_s) continue;
    const Eigen::Vector3d place = (robot_from_camera_ * proposal.camera_from_object).translation();
    const double distance = place.head<2>().norm(), bearing = std::atan2(place.y(), place.x());
    const double half = std::atan2(proposal.shape.radius() + kPersonMargin_m, std::max(0.3, distance));
    wedges.push_back({bearing - half, bearing + half, distance - kPersonDepth_m, distance + kPersonDepth_m});
  }
  Scan clean = scan;
  if (!wedges.empty()) counts_.returns_on_people += removeDynamicReturns(clean, wedges);
  return clean;
}

SlamResult SemanticSlam::finish() {
  refine();
  return collect();
}

// With all data: poses, landmarks, and who is who.
void SemanticSlam::refine() {
  const auto timing = times_.measure("hindsight");
  front_ends_.refine();
  // Alternate until nothing new is found: landmarks merge after poses moved, loops close after poses moved.
  for (int round = 0; round < 3; ++round) {
    if (!estimator_.optimizeAll(objects_)) ++counts_.reasons["back end: no usable solution"];
    if (!stages_->scan_loop_closer || estimator_.poses().empty()) continue;
    estimator_.addClosures(stages_->scan_loop_closer->search(estimator_.poses().trajectory()), objects_);
  }
  anchor();  // before the last optimisation, so that the graph is in the same frame as all else
  estimator_.optimizeAll(objects_);
  // Coordinate descent (sec. 4): who is who with the poses as they are, poses and places with who is who.
  for (int round = 0; round < kMaxDescents && objects_.reassociate(); ++round)
    estimator_.optimizeAll(objects_);
}

SlamResult SemanticSlam::collect() {
  const KeyPoses& poses = estimator_.poses();
  SlamResult result;
  result.counts = counts_;
  result.counts.key_poses = static_cast<int>(poses.nodes().size());
  result.counts.loop_closures = static_cast<int>(estimator_.measurements().closures.size());
  result.map.planar = estimator_.measurements().planar;
  if (poses.empty()) return result;
  result.map.landmarks = objects_.landmarks().confirmed();
  result.seen = objects_.seenSpans();
  if (const auto covariances = graph().landmarkCovariances())
    for (auto& landmark : result.map.landmarks)
      if (const auto found = covariances->find(landmark.id); found != covariances->end())
        landmark.covariance = found->second;
  if (map_) result.earlier = EarlierMap{};
  if (anchored_) {
    const auto& earlier = map_->map().landmarks;
    const std::size_t apart = result.map.landmarks.size() + earlier.size();
    result.map.landmarks = joined(result.map.landmarks, earlier);
    result.earlier = EarlierMap{true, static_cast<int>(apart - result.map.landmarks.size())};
  }
  Trajectory dense;
  for (const double t : robot_times_.empty() ? odometry_times_ : robot_times_)
    if (dense.empty() || t > dense.lastTime()) dense.add(t, poses.at(t));
  result.world_from_robot = result.map.world_from_robot = dense.poses();
  for (const auto& [t, mount] : camera_mounts_) result.world_from_camera.push_back({t, poses.at(t) * mount});
  const auto timing = times_.measure("occupancy map");
  try {
    result.map.occupancy = stages_->mapper.build(dense);
  } catch (const RunError& error) {  // all else is still good
    ++result.counts.reasons[error.what()];
  }
  return result;
}

}  // namespace roomgraph
