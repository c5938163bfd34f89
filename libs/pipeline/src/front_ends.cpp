// SPDX-License-Identifier: BSD-3-Clause
// Motion priors between sources, covariances of their steps, and verification of closures.
#include "roomgraph/pipeline/front_ends.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

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

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kAgreement_s = 0.5, kLate_s = 1;  // movements of which sensors are compared; a sensor that is late by more is away
constexpr double kCompared_m = 0.25, kCompared_rad = 0.25, kCompared_s = 5;  // movements by which wheels are calibrated, within so long
constexpr double kDense_s = 0.25;  // between poses of a sensor, of which what lies between two is known

// The last pose that is not after `t`.
std::optional<double> lastUntil(const Trajectory& trajectory, double t) {
  const auto& poses = trajectory.poses();
  for (std::size_t i = poses.size(); i-- > 0 && poses[i].t > t - kCompared_s;)
    if (poses[i].t <= t) return poses[i].t;
  return std::nullopt;
}

// Whether there are poses shortly before and after `t`, or at it.
bool isDense(const Trajectory& trajectory, double t) {
  const auto& poses = trajectory.poses();
  const auto after = std::lower_bound(poses.begin(), poses.end(), t, [](const StampedPose& pose, double time) { return pose.t < time; });
  if (after == poses.end()) return false;
  return after->t == t || (after != poses.begin() && after->t - std::prev(after)->t <= kDense_s);
}

// As a calibration file names it.
WheelCorrection correctionOf(const WheelErrors& errors) {
  return {1 / (1 + errors.length), 1 / (1 + errors.turn), -errors.turn_per_m / (1 + errors.turn)};
}

// Scans may have been matched before their turn, which a run that was interrupted did not come to.
Trajectory upTo(const Trajectory& all, double t) {
  Trajectory out;
  for (std::size_t i = 0; i < all.size() && all.poses()[i].t <= t; ++i) out.add(all.poses()[i].t, all.poses()[i].pose, all.segment(i));
  return out;
}

// Wheels with what is known of their errors in the end.
Trajectory calibrated(const Trajectory& as_read, const WheelCorrection& correction) {
  Trajectory out;
  const auto& poses = as_read.poses();
  Pose2 before = planarPart(poses[0].pose), at = before;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Pose2 now = planarPart(poses[i].pose);
    at = at * corrected(before.inverse() * now, correction);
    before = now;
    out.add(poses[i].t, toPose3(at), as_read.segment(i));
  }
  return out;
}

}  // namespace

FrontEnds::FrontEnds(const Stages& stages, const Options& options)
    : stages_(stages),
      options_(options),
      motion_{MotionSource(options.odometry.noise, true), MotionSource(options.tracking.noise, false),
              MotionSource(options.lidar.noise, true)},
      wheels_as_read_(options.odometry.noise, true),
      scans_ahead_(std::make_unique<ScansAhead>(
          stages.scan_matcher, options.odometry.enabled ? std::optional(options.odometry.noise) : std::nullopt)) {}

FrontEnds::~FrontEnds() = default;

WheelCorrection FrontEnds::wheelCorrection() const { return correctionOf(calibration_.errors()); }

bool FrontEnds::shareLabel() const {
  const auto &lidar = labels_[static_cast<std::size_t>(MotionSensor::kLidar)], &camera = labels_[static_cast<std::size_t>(MotionSensor::kCamera)];
  return lidar && lidar == camera;
}

void FrontEnds::setPlanar() {
  motion_.floor = OnFloor{options_.backend.planar_sigma_z_m, options_.backend.planar_sigma_tilt_rad};
}

bool FrontEnds::add(const OdometryReading& reading) {
  setPlanar();
  const Pose2 before = wheels_as_read_.poses().empty() ? reading.odom_from_robot : planarPart(wheels_as_read_.poses().poses().back().pose);
  if (!wheels_as_read_.add(reading.t, toPose3(reading.odom_from_robot), 0)) return false;
  labels_[static_cast<std::size_t>(MotionSensor::kWheels)] = "";
  const Pose2 step = before.inverse() * reading.odom_from_robot;
  wheels_ = wheels_ ? *wheels_ * corrected(step, wheelCorrection()) : reading.odom_from_robot;
  return motion_.odometry.add(reading.t, toPose3(*wheels_), 0);
}

// Of the movement up to the last time that every sensor has seen which goes on.
void FrontEnds::compareSensors() {
  const std::array sources = {&motion_.lidar, &motion_.visual, &motion_.odometry};
  double latest = -kInfinity, until = kInfinity;
  for (const auto* source : sources)
    if (!source->poses().empty()) latest = std::max(latest, source->poses().lastTime());
  for (const auto* source : sources)
    if (!source->poses().empty() && source->poses().lastTime() > latest - kLate_s) until = std::min(until, source->poses().lastTime());
  const double from = compared_t_.value_or(until);
  if (compared_t_ && until < from + kAgreement_s) return;
  compared_t_ = until;
  if (until <= from || until > from + 2 * kAgreement_s) return;  // after a gap
  MovementBySensor seen;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const bool told = sources[i] != &motion_.visual || (mounted_ && predicted_t_ < from);
    if (told && isDense(sources[i]->poses(), from) && isDense(sources[i]->poses(), until)) seen[i] = sources[i]->between(from, until, 0);
  }
  agreement_.compare(from, until, seen);
}

void FrontEnds::compareClocks() {
  static const Trajectory kNone;
  clocks_.compare(motion_.lidar.poses(), mounted_ ? motion_.visual.poses() : kNone, wheels_as_read_.poses(), predicted_t_);
}

// Over movements that both have seen to their end. A teacher that saw nothing for a while begins anew.
void FrontEnds::calibrateWheels(const MotionSource& teacher, std::optional<double>& taught_t) {
  const Trajectory &seen_poses = teacher.poses(), &wheel_poses = wheels_as_read_.poses();
  if (!options_.odometry.calibrate || wheel_poses.empty()) return;
  const auto t = lastUntil(seen_poses, wheel_poses.lastTime());
  if (!t || (taught_t && *t <= *taught_t)) return;
  const double from = taught_t.value_or(*t);
  const auto wheels = wheels_as_read_.between(from, *t, 0), seen = teacher.between(from, *t, 0);
  if (!taught_t || !wheels || !seen || *t - from > kCompared_s || !isDense(seen_poses, *t)) {
    taught_t = *t;
    return;
  }
  if (wheels->a_from_b.translation().norm() < kCompared_m && rotationAngle(wheels->a_from_b) < kCompared_rad) return;
  calibration_.compare(planarPart(wheels->a_from_b), *seen);
  taught_t = *t;
}

TrackingResult FrontEnds::track(const Frame& frame, const std::vector<Box2>& people) {
  labels_[static_cast<std::size_t>(MotionSensor::kCamera)] = frame.sensor_label;
  robot_from_camera_ = frame.robot_from_camera;
  mounted_ = isMounted(frame);
  if (mounted_) setPlanar();
  TrackingPrior prior{.dynamic_regions = people};
  if (last_frame_t_)
    if (const auto moved = predictedMovement(*last_frame_t_, frame.t, {&wheels_as_read_, &motion_.lidar})) {
      prior.previous_from_current = ofRobot(moved->a_from_b, robot_from_camera_.inverse());
      prior.sigma_m = std::sqrt(moved->covariance.diagonal().head<2>().maxCoeff());
      prior.sigma_rad = std::sqrt(moved->covariance(5, 5));
    }
  prior.by_scans = last_frame_t_ && predictedMovement(*last_frame_t_, frame.t, {&motion_.lidar}).has_value();
  last_frame_t_ = frame.t;
  TrackingResult result = stages_.rgbd_odometry->track(frame, prior);
  if (result.predicted) {  // by what it would be compared with
    taught_by_camera_.reset();
    predicted_t_ = frame.t;
  }
  if (result.tracked || result.predicted)
    motion_.visual.add(frame.t, ofRobot(result.odom_from_camera, robot_from_camera_), result.segment,
                       rotateCovariance(result.step_covariance, robot_from_camera_.linear()));
  if (motion_.lidar.poses().empty() || motion_.lidar.poses().lastTime() < frame.t - kCompared_s) calibrateWheels(motion_.visual, taught_by_camera_);
  compareSensors();
  compareClocks();
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
    if (const auto moved = predictedMovement(*last_scan_t_, scan.t, {&wheels_as_read_, &motion_.visual})) prior = planarPart(moved->a_from_b);
  last_scan_t_ = scan.t;
  labels_[static_cast<std::size_t>(MotionSensor::kLidar)] = scan.sensor_label;
  auto foreseen = scans_ahead_->take(scan.t);
  ScanMatch result = foreseen ? std::move(*foreseen) : stages_.scan_matcher->match(scan, prior);
  if (result.matched)
    motion_.lidar.add(scan.t, toPose3(result.odom_from_robot), result.segment,
                      planarCovariance(result.step_covariance));
  calibrateWheels(motion_.lidar, taught_by_lidar_);
  compareSensors();
  compareClocks();
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
  if (options_.odometry.calibrate && !wheels_as_read_.poses().empty())
    motion_.odometry.refine(calibrated(wheels_as_read_.poses(), wheelCorrection()));
}

void FrontEnds::releaseImages() {
  if (stages_.rgbd_odometry) stages_.rgbd_odometry->release();
}

void FrontEnds::releaseScans() {
  if (stages_.scan_loop_closer) stages_.scan_loop_closer->release();
}

}  // namespace roomgraph
