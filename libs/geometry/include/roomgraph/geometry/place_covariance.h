// SPDX-License-Identifier: BSD-3-Clause
// Rotation of a covariance of (x, y, z, yaw) into another frame.
#pragma once

#include <Eigen/Core>

namespace roomgraph {

/// Covariance of (x, y, z, yaw) in the frame that `rotation` leads to; of a yaw about an axis that stays
/// nearly vertical.
inline Eigen::Matrix4d turned(const Eigen::Matrix4d& covariance, const Eigen::Matrix3d& rotation) {
  Eigen::Matrix4d turn = Eigen::Matrix4d::Identity();
  turn.topLeftCorner<3, 3>() = rotation;
  return turn * covariance * turn.transpose();
}

}  // namespace roomgraph
