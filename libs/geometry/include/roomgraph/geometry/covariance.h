// SPDX-License-Identifier: BSD-3-Clause
// Rotation of covariances into another frame, and planar covariances in 3D.
#pragma once

#include <Eigen/Geometry>

#include "roomgraph/geometry/pose.h"

namespace roomgraph {

// `rotation` is a_from_b: the covariance is given in frame b and returned in frame a.

/// Covariance of (x, y, z, yaw); the yaw is about an axis that stays nearly vertical.
inline Eigen::Matrix4d rotateCovariance(const Eigen::Matrix4d& covariance, const Eigen::Matrix3d& rotation) {
  Eigen::Matrix4d turn = Eigen::Matrix4d::Identity();
  turn.topLeftCorner<3, 3>() = rotation;
  return turn * covariance * turn.transpose();
}

/// Covariance of (translation, rotation vector).
inline Matrix6d rotateCovariance(const Matrix6d& covariance, const Eigen::Matrix3d& rotation) {
  Matrix6d turn = Matrix6d::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = rotation;
  return turn * covariance * turn.transpose();
}

/// Covariance of (x, y, yaw); `yaw`: angle of a_from_b, rad.
inline Eigen::Matrix3d rotateCovariance(const Eigen::Matrix3d& covariance, double yaw) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(yaw).toRotationMatrix();
  return turn * covariance * turn.transpose();
}

/// Covariance of (translation, rotation) with that of (x, y, yaw); z, roll and pitch have variance `others`,
/// independent of the rest.
inline Matrix6d planarCovariance(const Eigen::Matrix3d& of_x_y_yaw, double others = 0) {
  Matrix6d out = others * Matrix6d::Identity();
  const int index[3] = {0, 1, 5};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) out(index[i], index[j]) = of_x_y_yaw(i, j);
  return out;
}

}  // namespace roomgraph
