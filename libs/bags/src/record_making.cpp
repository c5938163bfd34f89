// SPDX-License-Identifier: BSD-3-Clause
// Conventions of ROS turned into those of MRPT: sweeps, validity of ranges, depth units, times.
#include "record_making.h"

#include <cmath>
#include <numbers>

namespace roomgraph::bags {
namespace {

using Ticks = mrpt::Clock::time_point::duration;

mrpt::Clock::time_point unixEpoch() {
  return mrpt::Clock::fromDouble(0);
}

}  // namespace

mrpt::Clock::time_point toMrptTime(std::int64_t t_ns) {
  return unixEpoch() + std::chrono::duration_cast<Ticks>(std::chrono::nanoseconds(t_ns));
}

std::int64_t toNanoseconds(mrpt::Clock::time_point t) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(t - unixEpoch()).count();
}

std::int64_t halfSweepNs(const LaserScanMessage& scan) {
  constexpr double kLongest_s = 1;
  if (scan.ranges.empty() || !std::isfinite(scan.time_increment)) return 0;
  const double half = 0.5 * scan.time_increment * static_cast<double>(scan.ranges.size() - 1);
  return std::abs(half) < kLongest_s ? static_cast<std::int64_t>(std::llround(1e9 * half)) : 0;
}

mrpt::obs::CObservation2DRangeScan::Ptr makeScan(const LaserScanMessage& message, double& yaw) {
  const std::size_t count = message.ranges.size();
  const double step = message.angle_increment;
  if (count == 0) throw BadMessage("scan without beams");
  if (!std::isfinite(step) || !std::isfinite(message.angle_min) || (count > 1 && step == 0))
    throw BadMessage("scan with impossible angles");
  double end = message.angle_min + static_cast<double>(count - 1) * step;
  // Sums of single-precision steps drift; some drivers write an angle_max that is one beam off.
  if (std::abs(message.angle_max - end) < 0.01 * std::abs(step)) end = message.angle_max;
  const double aperture = std::abs(end - message.angle_min);
  if (aperture > 2 * std::numbers::pi + std::abs(step) || std::abs(message.angle_min) > 4 * std::numbers::pi)
    throw BadMessage("scan with impossible angles");
  yaw = 0.5 * (message.angle_min + end);
  auto scan = mrpt::obs::CObservation2DRangeScan::Create();
  scan->aperture = static_cast<float>(std::min(aperture, 2 * std::numbers::pi));
  scan->rightToLeft = step >= 0;
  scan->maxRange = std::isfinite(message.range_max) ? message.range_max : 0;
  scan->resizeScan(count);
  const bool intensities = message.intensities.size() == count;
  scan->setScanHasIntensity(intensities);
  for (std::size_t i = 0; i < count; ++i) {
    const float range = message.ranges[i];
    const bool valid = std::isfinite(range) && range > 0 && range >= message.range_min &&
                       (scan->maxRange <= 0 || range <= scan->maxRange);
    scan->setScanRange(i, std::isfinite(range) ? range : 0);
    scan->setScanRangeValidity(i, valid);
    if (!intensities) continue;
    const float intensity = message.intensities[i];
    scan->setScanIntensity(i, std::abs(intensity) < 2e9f ? static_cast<int>(std::lround(intensity)) : 0);
  }
  return scan;
}

mrpt::obs::CObservationOdometry::Ptr makeOdometry(const Pose3& odom_from_robot) {
  const Pose2 pose = planarPart(odom_from_robot);
  auto odometry = mrpt::obs::CObservationOdometry::Create();
  odometry->odometry = {pose.x, pose.y, pose.yaw};
  return odometry;
}

mrpt::obs::CObservationOdometry::Ptr makeOdometry(const OdometryMessage& message) {
  auto odometry = makeOdometry(message.pose);
  const auto& v = message.twist;
  odometry->hasVelocities = std::isfinite(v[0] + v[1] + v[5]);
  if (odometry->hasVelocities) odometry->velocityLocal = {v[0], v[1], v[5]};
  return odometry;
}

OdometryMessage movedTo(const OdometryMessage& odometry, const Pose3& child_from_other) {
  OdometryMessage out = odometry;
  out.pose = normalized(odometry.pose * child_from_other);
  Eigen::Map<Eigen::Vector3d> linear(out.twist.data()), angular(out.twist.data() + 3);
  const Eigen::Matrix3d other_from_child = child_from_other.linear().transpose();
  linear = other_from_child * (linear + angular.cross(child_from_other.translation())).eval();
  angular = (other_from_child * angular).eval();
  return out;
}

mrpt::obs::CObservationIMU::Ptr makeImu(const ImuMessage& message) {
  using namespace mrpt::obs;
  auto imu = CObservationIMU::Create();
  const auto set = [&](bool present, auto first, const auto& values) {
    for (std::size_t i = 0; present && i < values.size(); ++i) {
      if (!std::isfinite(values[i])) throw BadMessage("measurement is not finite");
      imu->set(static_cast<TIMUDataIndex>(first + static_cast<int>(i)), values[i]);
    }
  };
  set(message.has_orientation, IMU_ORI_QUAT_X, message.orientation);
  set(message.has_linear_acceleration, IMU_X_ACC, message.linear_acceleration);
  // MRPT counts them the other way round.
  const auto& w = message.angular_velocity;
  set(message.has_angular_velocity, IMU_YAW_VEL, std::array{w[2], w[1], w[0]});
  if (!message.has_orientation && !message.has_angular_velocity && !message.has_linear_acceleration)
    throw BadMessage("measures nothing");
  return imu;
}

}  // namespace roomgraph::bags
