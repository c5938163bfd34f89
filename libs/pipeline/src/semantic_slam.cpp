// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/pipeline/semantic_slam.h"

#include <mrpt/system/CTimeLogger.h>

#include <cmath>

#include "roomgraph/lidar/dynamic_return_filter.h"
#include "roomgraph/pipeline/object_mapper.h"

namespace roomgraph {
namespace {

constexpr double kPriorHorizon_s = 0.15;  // a source may be extrapolated this far to predict another's movement
constexpr double kPeopleMaxAge_s = 0.3;

Pose3 movedCamera(const Pose3& robot_movement, const Pose3& robot_from_camera) {
  return robot_from_camera.inverse() * robot_movement * robot_from_camera;
}

Matrix6d planarCovariance(const Eigen::Matrix3d& of_x_y_yaw) {
  Matrix6d out = Matrix6d::Zero();
  const int index[3] = {0, 1, 5};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) out(index[i], index[j]) = of_x_y_yaw(i, j);
  return out;
}

}  // namespace

SemanticSlam::SemanticSlam(std::unique_ptr<Stages> stages)
    : stages_(std::move(stages)),
      timer_(std::make_unique<mrpt::system::CTimeLogger>(true, "", false)),
      motion_{MotionSource(stages_->odometry.noise, true), MotionSource(stages_->tracking.noise, false),
              MotionSource(stages_->lidar.noise, true)},
      poses_(motion_) {
  measurements_.planar = false;
}

SemanticSlam::~SemanticSlam() { timer_->clear(true); }

void SemanticSlam::addSink(std::shared_ptr<Sink> sink) { sinks_.push_back(std::move(sink)); }

void SemanticSlam::process(const Record& record) {
  const StepReport report = std::visit([this](const auto& value) { return step(value); }, record);
  for (const auto& sink : sinks_) sink->onStep(report);
}

StepReport SemanticSlam::step(const OdometryReading& reading) {
  StepReport report;
  report.t = reading.t;
  if (!stages_->odometry.enabled) return report;
  measurements_.planar = true;
  ++counts_.odometry;
  if (!motion_.odometry.add(reading.t, toPose3(reading.odom_from_robot), 0, Matrix6d::Zero()))
    ++counts_.reasons["odometry: stamp does not come after the previous one"];
  return report;
}

StepReport SemanticSlam::step(const std::shared_ptr<CObservationDetections>& recorded) {
  StepReport report;
  ++counts_.detections;
  if (stages_->detector) stages_->detector->feed(*recorded);
  return report;
}

StepReport SemanticSlam::step(const Scan& scan) {
  StepReport report{.kind = StepReport::Kind::kScan, .t = scan.t};
  if (!stages_->scan_matcher) return {};
  if (last_scan_t_ && scan.t <= *last_scan_t_) {
    ++counts_.reasons["lidar: stamp does not come after the previous one"];
    return {};
  }
  measurements_.planar = true;
  ++counts_.scans;
  int removed = 0;
  const Scan clean = withoutPeople(scan, removed);
  std::optional<Pose2> prior;
  if (last_scan_t_)
    for (const auto* source : {&motion_.odometry, &motion_.visual})
      if (const auto moved = source->between(*last_scan_t_, scan.t, kPriorHorizon_s); moved && !prior)
        prior = planarPart(moved->a_from_b);
  timer_->enter("scan matching");
  const ScanMatch match = stages_->scan_matcher->match(clean, prior);
  timer_->leave("scan matching");
  if (match.matched) {
    motion_.lidar.add(scan.t, toPose3(match.odom_from_robot), match.segment, planarCovariance(match.step_covariance));
  } else {
    ++counts_.scans_unmatched;
    ++counts_.reasons["lidar: " + match.reason];
    report.note = "scan not matched: " + match.reason;
  }
  stages_->mapper.add(clean);
  const bool added = advance(scan.t);
  if (match.matched && stages_->scan_loop_closer) stages_->scan_loop_closer->add(clean, match);
  if (added) closeScanLoops();
  last_scan_t_ = scan.t;
  robot_times_.push_back(scan.t);
  report.world_from_robot = poses_.at(scan.t);
  return report;
}

StepReport SemanticSlam::step(const Frame& frame) {
  StepReport report{.kind = StepReport::Kind::kFrame, .t = frame.t, .frame = frame.id};
  if (last_frame_ && frame.t <= last_frame_->t) {
    ++counts_.reasons["frames: stamp does not come after the previous one"];
    return {};
  }
  ++counts_.frames;
  mounted_ = frame.robot_from_camera.translation().z() > 0.1;
  measurements_.planar |= mounted_;
  last_robot_from_camera_ = frame.robot_from_camera;
  const std::vector<Detection> detections = detect(frame, report);
  track(frame, detections, report);
  advance(frame.t);
  seeObjects(frame, detections, report);
  robot_times_.push_back(frame.t);
  camera_times_.emplace_back(frame.t, frame.robot_from_camera);
  last_frame_ = frame;
  last_frame_->color = last_frame_->gray = last_frame_->depth = cv::Mat();
  report.world_from_robot = poses_.at(frame.t);
  return report;
}

std::vector<Detection> SemanticSlam::detect(const Frame& frame, StepReport& report) {
  if (!stages_->detector) return {};
  mrpt::system::CTimeLoggerEntry timing(*timer_, "detection");
  const auto found = stages_->detector->detect(frame);
  if (!found) {
    ++counts_.reasons["detection: " + found.reason()];
    return {};
  }
  report.detector_ran = true;
  report.detections = *found;
  people_.clear();
  for (const auto& detection : *found) {
    const auto* model = stages_->database.find(detection.class_name);
    if (model && !model->landmark) people_.push_back(detection.box);
  }
  return *found;
}

void SemanticSlam::track(const Frame& frame, const std::vector<Detection>&, StepReport& report) {
  if (!stages_->rgbd_odometry) return;
  TrackingPrior prior;
  prior.dynamic_regions = people_;
  if (last_frame_)
    for (const auto* source : {&motion_.odometry, &motion_.lidar})
      if (const auto moved = source->between(last_frame_->t, frame.t, kPriorHorizon_s);
          moved && !prior.previous_from_current)
        prior.previous_from_current = movedCamera(moved->a_from_b, frame.robot_from_camera);
  timer_->enter("RGB-D odometry");
  const TrackingResult result = stages_->rgbd_odometry->track(frame, prior);
  timer_->leave("RGB-D odometry");
  if (!result.tracked) {
    ++counts_.frames_lost;
    ++counts_.reasons["tracking: " + result.reason];
    report.note = "not tracked: " + result.reason;
    return;
  }
  const Pose3 robot_from_camera = frame.robot_from_camera;
  Matrix6d turn = Matrix6d::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = robot_from_camera.linear();
  motion_.visual.add(frame.t, robot_from_camera * result.odom_from_camera * robot_from_camera.inverse(), result.segment,
                     turn * result.step_covariance * turn.transpose());
  if (!stages_->tracking.loop_closing) return;
  for (RelativePose closure : stages_->rgbd_odometry->takeLoopClosures()) {
    closure.a_from_b = robot_from_camera * closure.a_from_b * robot_from_camera.inverse();
    closure.covariance = (turn * closure.covariance * turn.transpose()).eval();
    measurements_.closures.push_back(closure);
  }
}

bool SemanticSlam::advance(double t) {
  if (poses_.empty()) {
    poses_.add(t, Pose3::Identity());
    return true;
  }
  const KeyPose& last = poses_.nodes().back();
  const Pose3 moved = poses_.offset(last, t);
  const auto& options = stages_->backend;
  const bool due = moved.translation().norm() > options.node_distance_m ||
                   rotationAngle(moved) > options.node_angle_rad || t - last.t > options.node_interval_s;
  if (!due || t <= last.t) return false;
  poses_.add(t, last.world_from_robot * moved);
  ++nodes_since_optimization_;
  const bool closed = measurements_.closures.size() > closures_optimized_;
  const int pause = closed ? std::max(1, stages_->backend.optimize_every_nodes / 4) : options.optimize_every_nodes;
  if (nodes_since_optimization_ >= pause) {
    optimizeAll();
  } else {
    optimizeWindow();
  }
  return true;
}

void SemanticSlam::seeObjects(const Frame& frame, const std::vector<Detection>& detections, StepReport& report) {
  if (!frame.hasDepth() && detections.empty()) return;
  std::optional<Plane> expected;
  if (mounted_) {
    expected = groundInCamera(frame.robot_from_camera);
  } else if (levelled_) {
    expected = groundInCamera(poses_.at(frame.t) * frame.robot_from_camera);
  }
  timer_->enter("proposals");
  last_seen_ = stages_->proposal_generator->generate(frame, detections, expected);
  timer_->leave("proposals");
  if (!last_seen_.ground) ++counts_.reasons["ground: " + last_seen_.ground_reason];
  level(frame, last_seen_);
  if (stages_->scan_matcher == nullptr || counts_.scans == 0)
    if (last_seen_.ground) stages_->mapper.add(frame, last_seen_.ground->plane);
  if (!report.detector_ran || !last_seen_.ground) return;

  mrpt::system::CTimeLoggerEntry timing(*timer_, "selection and association");
  const auto selected = stages_->proposal_selector->select({last_seen_, frame.camera, std::nullopt});
  std::vector<ObjectMeasurement> objects;
  for (const auto& measurement : selected) {
    const auto* model = stages_->database.find(measurement.proposal.class_name);
    if (model && model->landmark) objects.push_back(measurement);
  }
  const KeyPose& node = poses_.nearest(frame.t);
  const PosedFrame posed{frame, poses_.at(frame.t), node, poses_.offset(node, frame.t)};
  report.decisions = mapObjects(objects, posed, stages_->backend.pose_sigma_m, *stages_->associator,
                                stages_->landmarks, measurements_.sightings);
  missUnseen(report.decisions, posed, stages_->landmarks);
}

// A handheld camera's world is levelled when the floor is seen for the first time; later sightings become factors.
void SemanticSlam::level(const Frame& frame, const FrameProposals& seen) {
  if (measurements_.planar || !seen.ground || !seen.ground->from_depth) return;
  const Plane& plane = seen.ground->plane;
  if (!levelled_) {
    const Pose3 world_from_camera = poses_.at(frame.t) * frame.robot_from_camera;
    const Pose3 level_from_camera = cameraFromGround(plane).inverse();
    Pose3 level_from_world = level_from_camera * world_from_camera.inverse();
    const Pose2 first = planarPart(level_from_world * poses_.nodes().front().world_from_robot);
    level_from_world = toPose3(first.inverse()) * level_from_world;
    for (auto& node : poses_.nodes()) node.world_from_robot = level_from_world * node.world_from_robot;
    stages_->landmarks.transform(level_from_world);
    levelled_ = true;
  }
  const KeyPose& node = poses_.nodes().back();
  if (node.t != frame.t) return;
  GroundFactor factor;
  factor.node = node.id;
  factor.normal_in_robot = frame.robot_from_camera.linear() * plane.normal;
  factor.offset_m = plane.offset - factor.normal_in_robot.dot(frame.robot_from_camera.translation());
  measurements_.grounds.push_back(factor);
}

void SemanticSlam::closeScanLoops() {
  if (!stages_->scan_loop_closer) return;
  mrpt::system::CTimeLoggerEntry timing(*timer_, "scan loop closing");
  const auto found = stages_->scan_loop_closer->search(poses_.trajectory());
  measurements_.closures.insert(measurements_.closures.end(), found.begin(), found.end());
}

void SemanticSlam::optimizeWindow() {
  mrpt::system::CTimeLoggerEntry timing(*timer_, "window optimisation");
  auto& nodes = poses_.nodes();
  const auto window = static_cast<std::size_t>(stages_->backend.window_nodes);
  const std::size_t first = nodes.size() > window ? nodes.size() - window : 0;
  FactorGraph graph = buildGraph(poses_, motion_, measurements_, {}, stages_->backend, first);
  if (!graph.optimize(stages_->backend.max_iterations).usable) return;
  for (std::size_t i = first; i < nodes.size(); ++i) nodes[i].world_from_robot = graph.pose(nodes[i].id);
}

void SemanticSlam::optimizeAll() {
  if (poses_.empty()) return;
  mrpt::system::CTimeLoggerEntry timing(*timer_, "graph optimisation");
  nodes_since_optimization_ = 0;
  closures_optimized_ = measurements_.closures.size();
  for (const auto& [removed, kept] : stages_->landmarks.mergeDuplicates())
    for (auto& sighting : measurements_.sightings)
      if (sighting.landmark == removed) sighting.landmark = kept;
  graph_ = buildGraph(poses_, motion_, measurements_, stages_->landmarks.landmarks(), stages_->backend);
  if (!graph_.optimize(stages_->backend.max_iterations).usable) {
    ++counts_.reasons["back end: no usable solution"];
    return;
  }
  for (auto& node : poses_.nodes()) node.world_from_robot = graph_.pose(node.id);
  std::vector<Landmark> moved;
  for (const auto& landmark : stages_->landmarks.landmarks())
    if (graph_.hasLandmark(landmark.id)) moved.push_back(landmark);
  for (const auto& landmark : moved) {
    const LandmarkEstimate estimate = graph_.landmark(landmark.id);
    stages_->landmarks.correct(landmark.id, estimate.position, estimate.yaw, landmark.covariance);
  }
}

// Returns inside the wedge of a person's box, at the person's depth (method.md sec. 5).
Scan SemanticSlam::withoutPeople(const Scan& scan, int& removed) const {
  if (std::abs(last_seen_.t - scan.t) > kPeopleMaxAge_s) return scan;
  std::vector<DynamicWedge> wedges;
  for (const auto& proposal : last_seen_.proposals) {
    const auto* model = stages_->database.find(proposal.class_name);
    if (!model || model->landmark) continue;
    const Eigen::Vector3d place = (last_robot_from_camera_ * proposal.camera_from_object).translation();
    const double distance = place.head<2>().norm(), bearing = std::atan2(place.y(), place.x());
    const double half = std::atan2(proposal.shape.radius() + 0.15, std::max(0.3, distance));
    wedges.push_back({bearing - half, bearing + half, distance - 0.6, distance + 0.6});
  }
  Scan clean = scan;
  if (!wedges.empty()) removed = removeDynamicReturns(clean, wedges);
  return clean;
}

SlamResult SemanticSlam::finish() {
  if (stages_->rgbd_odometry) {
    Trajectory refined;
    const Trajectory camera = stages_->rgbd_odometry->trajectory();
    const Pose3& robot_from_camera = last_robot_from_camera_;
    for (std::size_t i = 0; i < camera.size(); ++i)
      refined.add(camera.poses()[i].t, robot_from_camera * camera.poses()[i].pose * robot_from_camera.inverse(),
                  camera.segment(i));
    if (!refined.empty()) motion_.visual.refine(refined);
  }
  if (stages_->scan_matcher && !stages_->scan_matcher->trajectory().empty())
    motion_.lidar.refine(stages_->scan_matcher->trajectory());
  // Alternate: landmarks merge after poses moved, poses move after landmarks merged (method.md sec. 4).
  for (int round = 0; round < 3; ++round) {
    optimizeAll();
    closeScanLoops();
  }
  optimizeAll();
  return collect();
}

SlamResult SemanticSlam::collect() {
  SlamResult result;
  result.counts = counts_;
  result.counts.key_poses = static_cast<int>(poses_.nodes().size());
  result.counts.loop_closures = static_cast<int>(measurements_.closures.size());
  result.map.planar = measurements_.planar;
  if (poses_.empty()) return result;
  const auto covariances = graph_.landmarkCovariances();
  result.map.landmarks = stages_->landmarks.confirmed();
  for (auto& landmark : result.map.landmarks)
    if (covariances && covariances->contains(landmark.id)) landmark.covariance = covariances->at(landmark.id);
  for (const double t : robot_times_) {
    if (!result.world_from_robot.empty() && t <= result.world_from_robot.back().t) continue;
    result.world_from_robot.push_back({t, poses_.at(t)});
  }
  for (const auto& [t, robot_from_camera] : camera_times_)
    result.world_from_camera.push_back({t, poses_.at(t) * robot_from_camera});
  Trajectory dense;
  for (const auto& stamped : result.world_from_robot) dense.add(stamped.t, stamped.pose);
  mrpt::system::CTimeLoggerEntry timing(*timer_, "occupancy map");
  result.map.occupancy = stages_->mapper.build(dense);
  result.map.world_from_robot = result.world_from_robot;
  return result;
}

std::map<std::string, std::array<double, 3>> SemanticSlam::timings() const {
  std::map<std::string, mrpt::system::CTimeLogger::TCallStats> stats;
  timer_->getStats(stats);
  std::map<std::string, std::array<double, 3>> out;
  for (const auto& [name, call] : stats)
    out[name] = {static_cast<double>(call.n_calls), 1e3 * call.mean_t, 1e3 * call.total_t};
  return out;
}

}  // namespace roomgraph
