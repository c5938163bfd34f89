// SPDX-License-Identifier: BSD-3-Clause
// Conversion between the error of g2o's EDGE_SE3:QUAT and that of the factors.
#pragma once

#include "roomgraph/backend/factors.h"
#include "roomgraph/geometry/shape_math.h"

namespace roomgraph {

// g2o's error of EDGE_SE3:QUAT is (translation, quaternion's x y z) of measured^-1 * estimated. Ours is the same
// translation before its rotation into the measured b frame, and twice the quaternion (a rotation vector for small
// errors): ours = D g2o with D = diag(R_measured, 2 I). With the information matrices converted accordingly both give
// the same chi^2.

constexpr double kLeastWeight = 1e-9;       ///< of a landmark's measurement; with less it gives no edge
constexpr double kTokenInformation = 1e-3;  ///< of directions that a landmark's measurement does not observe

inline Matrix6d errorFromG2o(const Eigen::Matrix3d& measured) {
  Matrix6d d = Matrix6d::Zero();
  d.topLeftCorner<3, 3>() = measured;
  d.bottomRightCorner<3, 3>() = 2 * Eigen::Matrix3d::Identity();
  return d;
}

inline Matrix6d g2oInformation(const Pose3& measured, const Matrix6d& covariance) {
  const Matrix6d d = errorFromG2o(measured.linear());
  return d.transpose() * covariance.inverse() * d;
}

inline Matrix6d covarianceOfG2o(const Pose3& measured, const Matrix6d& information) {
  const Matrix6d d = errorFromG2o(measured.linear());
  return d * information.inverse() * d.transpose();
}

/// Covariance of (x, y, z, yaw) from world into the frame of something that is turned by `yaw`, and back with
/// -yaw.
inline Eigen::Matrix4d turnedBy(const Eigen::Matrix4d& covariance, double yaw) {
  Eigen::Matrix4d turn = Eigen::Matrix4d::Identity();
  turn.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(-yaw).toRotationMatrix();
  return turn * covariance * turn.transpose();
}

/// Where a view stands beside its landmark, in the landmark's frame.
inline Eigen::Vector2d offsetOf(const LandmarkViewFactor& f, const ObjectShape& shape) {
  return f.offset_m + f.offset_by_size * sizeOf(shape);
}

/// Covariance of a view's edge, in the frame of its landmark. One without a yaw has a vertex that is free to turn: its
/// horizontal covariance is made the same in all directions, or the solver would turn it to where errors cost least.
inline Eigen::Matrix4d edgeCovariance(const LandmarkViewFactor& f, double landmark_yaw) {
  if (f.has_yaw) return turnedBy(f.covariance, landmark_yaw) / f.weight;
  Eigen::Matrix4d round = Eigen::Matrix4d::Identity();
  round.topLeftCorner<2, 2>() *= f.covariance.topLeftCorner<2, 2>().trace() / 2;
  round(2, 2) = f.covariance(2, 2);
  return round / f.weight;
}

/// Of the landmark, counted from the robot's own x axis.
inline double yawInRobot(const LandmarkFactor& f) {
  return wrapAngle(f.yaw_in_robot + std::atan2(f.ahead_in_robot.y(), f.ahead_in_robot.x()));
}

/// Position and yaw of a landmark in the robot's frame as the transform of an edge.
inline Pose3 measuredTransform(const LandmarkFactor& f) {
  const auto& p = f.position_in_robot;
  return poseFromYpr(p.x(), p.y(), p.z(), f.has_yaw ? yawInRobot(f) : 0, 0, 0);
}

}  // namespace roomgraph
