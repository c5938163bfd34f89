// SPDX-License-Identifier: BSD-3-Clause
// Increments of 2D and 3D movements, wheel odometry preferred, with plausibility limits.
#include "odometry_sum.h"

#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CActionRobotMovement3D.h>

#include "plausibility.h"

namespace roomgraph {
namespace {

using mrpt::obs::CActionRobotMovement2D;
using mrpt::obs::CActionRobotMovement3D;

constexpr double kLargestStep_m = 1000;

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

std::string OdometrySum::add(const mrpt::obs::CActionCollection& actions) {
  // Wheel odometry is preferred to what a scan matcher once wrote into the recording.
  std::optional<Pose3> movement;
  std::optional<double> t;
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
    t = toSeconds(action.timestamp);
  }
  if (!movement) return "no movement of the robot in it";
  if (const auto problem = problemOf(*movement); !problem.empty()) return "movement: " + problem;
  if (t && !plausibleTime(*t)) return "time stamp is not between 1970 and 2200";
  if (movement->translation().norm() > kLargestStep_m) return "movement of more than 1 km in one record";
  odom_from_robot_ = normalized(odom_from_robot_ * *movement);
  time_ = t;
  return "";
}

}  // namespace roomgraph
