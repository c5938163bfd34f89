// SPDX-License-Identifier: BSD-3-Clause
// Motion priors between sources, covariances of their steps, and verification of closures.
#include "roomgraph/pipeline/front_ends.h"

#include "predicted_movement.h"
#include "roomgraph/geometry/covariance.h"
#include "roomgraph/observations/mounting.h"
#include "scans_ahead.h"

namespace roomgraph {
namespace {

// What the camera's movement is for the robot it is mounted on.
Pose3 ofRobot(const Pose3& camera_movement, const Pose3& robot_from_camera) {
  return robot_from_camera * camera_movement * robot_from_camera.inverse();
}

// Scans may have been matched before their turn, which a run that was interrupted did not come to.
Trajectory upTo(const Trajectory& all, double t) {
  Trajectory out;
  for (std::size_t i = 0; i < all.size() && all.poses()[i].t <= t; ++i) out.add(all.poses()[i].t, all.poses()[i].pose, all.segment(i));
  return out;
}

}  // namespace

FrontEnds::FrontEnds(const Stages& stages, const Options& options)
    : stages_(stages),
      options_(options),
      motion_{MotionSource(options.odometry.noise, true), MotionSource(options.tracking.noise, false),
              MotionSource(options.lidar.noise, true)},
      scans_ahead_(std::make_unique<ScansAhead>(
          stages.scan_matcher, options.odometry.enabled ? std::optional(options.odometry.noise) : std::nullopt)) {}

FrontEnds::~FrontEnds() = default;

void FrontEnds::setPlanar() {
  motion_.floor = OnFloor{options_.backend.planar_sigma_z_m, options_.backend.planar_sigma_tilt_rad};
}

bool FrontEnds::add(const OdometryReading& reading) {
  setPlanar();
  return motion_.odometry.add(reading.t, toPose3(reading.odom_from_robot), 0);
}

TrackingResult FrontEnds::track(const Frame& frame, const std::vector<Box2>& people) {
  robot_from_camera_ = frame.robot_from_camera;
  if (isMounted(frame)) setPlanar();
  TrackingPrior prior{.dynamic_regions = people};
  if (last_frame_t_)
    if (const auto moved = predictedMovement(*last_frame_t_, frame.t, {&motion_.odometry, &motion_.lidar}))
      prior.previous_from_current = ofRobot(*moved, robot_from_camera_.inverse());
  prior.by_scans = last_frame_t_ && predictedMovement(*last_frame_t_, frame.t, {&motion_.lidar});
  last_frame_t_ = frame.t;
  TrackingResult result = stages_.rgbd_odometry->track(frame, prior);
  if (result.tracked || result.predicted)
    motion_.visual.add(frame.t, ofRobot(result.odom_from_camera, robot_from_camera_), result.segment,
                       rotateCovariance(result.step_covariance, robot_from_camera_.linear()));
  return result;
}

void FrontEnds::foresee(const Record& record) {
  scans_ahead_->see(record);
  if (const auto* frame = std::get_if<Frame>(&record); frame && stages_.rgbd_odometry) stages_.rgbd_odometry->foresee(*frame);
}

ScanMatch FrontEnds::match(const Scan& scan) {
  setPlanar();
  std::optional<Pose2> prior;
  if (last_scan_t_)
    if (const auto moved = predictedMovement(*last_scan_t_, scan.t, {&motion_.odometry, &motion_.visual})) prior = planarPart(*moved);
  last_scan_t_ = scan.t;
  auto foreseen = scans_ahead_->take(scan.t);
  ScanMatch result = foreseen ? std::move(*foreseen) : stages_.scan_matcher->match(scan, prior);
  if (result.matched)
    motion_.lidar.add(scan.t, toPose3(result.odom_from_robot), result.segment,
                      planarCovariance(result.step_covariance));
  return result;
}

std::vector<RelativePose> FrontEnds::takeImageClosures() {
  if (!stages_.rgbd_odometry) return {};
  std::vector<RelativePose> closures = stages_.rgbd_odometry->takeLoopClosures();
  if (!options_.tracking.loop_closing)
    std::erase_if(closures, [](const RelativePose& closure) { return !closure.link; });
  for (auto& closure : closures) toRobot(closure);
  return closures;
}

void FrontEnds::toRobot(RelativePose& of_camera) const {
  of_camera.a_from_b = ofRobot(of_camera.a_from_b, robot_from_camera_);
  of_camera.covariance = rotateCovariance(of_camera.covariance, robot_from_camera_.linear());
}

std::optional<RelativePose> FrontEnds::verify(const RelativePose& proposed) {
  if (stages_.scan_loop_closer)
    if (auto closure = stages_.scan_loop_closer->verify(proposed)) return closure;
  if (!stages_.rgbd_odometry) return std::nullopt;
  RelativePose of_camera = proposed;
  of_camera.a_from_b = ofRobot(proposed.a_from_b, robot_from_camera_.inverse());
  auto closure = stages_.rgbd_odometry->verifyLoop(of_camera);
  if (closure) toRobot(*closure);
  return closure;
}

void FrontEnds::refine() {
  if (stages_.rgbd_odometry) {
    const Trajectory camera = stages_.rgbd_odometry->trajectory();
    Trajectory robot;
    for (std::size_t i = 0; i < camera.size(); ++i)
      robot.add(camera.poses()[i].t, ofRobot(camera.poses()[i].pose, robot_from_camera_), camera.segment(i));
    if (!robot.empty()) motion_.visual.refine(robot);
  }
  if (stages_.scan_matcher && last_scan_t_)
    if (const Trajectory scans = upTo(stages_.scan_matcher->trajectory(), *last_scan_t_); !scans.empty())
      motion_.lidar.refine(scans);
}

void FrontEnds::releaseImages() {
  if (stages_.rgbd_odometry) stages_.rgbd_odometry->release();
}

void FrontEnds::releaseScans() {
  if (stages_.scan_loop_closer) stages_.scan_loop_closer->release();
}

}  // namespace roomgraph
