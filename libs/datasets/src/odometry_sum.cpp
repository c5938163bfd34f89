// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "odometry_sum.h"

#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CActionRobotMovement3D.h>

namespace roomgraph {
namespace {

using mrpt::obs::CActionRobotMovement2D;
using mrpt::obs::CActionRobotMovement3D;

Pose3 increment(const CActionRobotMovement2D& movement) {
  const auto& raw = movement.rawOdometryIncrementReading;
  const bool has_raw = raw.x() != 0 || raw.y() != 0 || raw.phi() != 0;
  if (movement.estimationMethod == CActionRobotMovement2D::emOdometry && has_raw)
    return toPose3(mrpt::poses::CPose3D(raw));
  if (!movement.poseChange) return Pose3::Identity();
  return toPose3(mrpt::poses::CPose3D(movement.poseChange->getMeanVal()));
}

Pose3 increment(const CActionRobotMovement3D& movement) {
  const auto& raw = movement.rawOdometryIncrementReading;
  const bool has_raw = raw.norm() > 0 || raw.yaw() != 0 || raw.pitch() != 0 || raw.roll() != 0;
  if (movement.estimationMethod == CActionRobotMovement3D::emOdometry && has_raw) return toPose3(raw);
  return toPose3(movement.poseChange.mean);
}

}  // namespace

std::optional<double> toSeconds(const mrpt::Clock::time_point& time) {
  if (time == INVALID_TIMESTAMP) return std::nullopt;
  return mrpt::Clock::toDouble(time);
}

bool OdometrySum::add(const mrpt::obs::CActionCollection& actions) {
  // Wheel odometry is preferred to what a scan matcher once wrote into the recording.
  std::optional<Pose3> movement;
  bool from_wheels = false;
  for (std::size_t i = 0; i < actions.size(); ++i) {
    const auto& action = actions.get(i);
    if (from_wheels) break;
    if (const auto* planar = dynamic_cast<const CActionRobotMovement2D*>(&action)) {
      from_wheels = planar->estimationMethod == CActionRobotMovement2D::emOdometry;
      if (from_wheels || !movement) movement = increment(*planar);
    } else if (const auto* spatial = dynamic_cast<const CActionRobotMovement3D*>(&action)) {
      from_wheels = spatial->estimationMethod == CActionRobotMovement3D::emOdometry;
      if (from_wheels || !movement) movement = increment(*spatial);
    } else {
      continue;
    }
    time_ = toSeconds(action.timestamp);
  }
  if (!movement) return false;
  odom_from_robot_ = normalized(odom_from_robot_ * *movement);
  return true;
}

}  // namespace roomgraph
