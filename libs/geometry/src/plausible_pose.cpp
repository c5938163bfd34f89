// SPDX-License-Identifier: BSD-3-Clause
// Checks of 3D and 2D poses for finite values, range and orthonormality.
#include "roomgraph/geometry/plausible_pose.h"

#include <cmath>

namespace roomgraph {

std::string problemOf(const Pose3& pose, double rounding) {
  if (!pose.matrix().allFinite()) return "pose is not finite";
  if (!(pose.translation().norm() < kFarthest_m)) return "pose is more than 1000 km away";
  const Eigen::Matrix3d rotation = pose.linear();
  return rotation.isUnitary(rounding) && rotation.determinant() > 0 ? "" : "pose's rotation is none";
}

std::string problemOf(const Pose2& pose) {
  // Sine and cosine of a far larger angle are rounding noise.
  constexpr double kLargestAngle_rad = 1e6;
  if (!std::isfinite(pose.x) || !std::isfinite(pose.y) || !std::isfinite(pose.yaw))
    return "pose is not finite";
  if (!(std::hypot(pose.x, pose.y) < kFarthest_m)) return "pose is more than 1000 km away";
  return std::abs(pose.yaw) < kLargestAngle_rad ? "" : "pose's angle is too large";
}

}  // namespace roomgraph
