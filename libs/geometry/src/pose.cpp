// SPDX-License-Identifier: BSD-3-Clause
// Planar poses, exponential and logarithm of SO(3), interpolation.
#include "roomgraph/geometry/pose.h"

#include <mrpt/math/wrap2pi.h>

#include <numbers>

namespace roomgraph {

Pose2 Pose2::operator*(const Pose2& other) const {
  const Eigen::Vector2d p = *this * Eigen::Vector2d(other.x, other.y);
  return {p.x(), p.y(), wrapAngle(yaw + other.yaw)};
}

Pose2 Pose2::inverse() const {
  const double c = std::cos(yaw), s = std::sin(yaw);
  return {-c * x - s * y, s * x - c * y, wrapAngle(-yaw)};
}

Eigen::Vector2d Pose2::operator*(const Eigen::Vector2d& point) const {
  const double c = std::cos(yaw), s = std::sin(yaw);
  return {x + c * point.x() - s * point.y(), y + s * point.x() + c * point.y()};
}

double wrapAngle(double radians) {
  // MRPT wraps into [-pi, pi).
  const double wrapped = mrpt::math::wrapToPi(radians);
  return wrapped <= -std::numbers::pi ? std::numbers::pi : wrapped;
}

Pose3 toPose3(const Pose2& pose) {
  return poseFromYpr(pose.x, pose.y, 0, pose.yaw, 0, 0);
}

Pose2 planarPart(const Pose3& pose) {
  const Eigen::Vector3d x_axis = pose.linear().col(0);
  return {pose.translation().x(), pose.translation().y(), std::atan2(x_axis.y(), x_axis.x())};
}

Pose3 poseFromYpr(double x, double y, double z, double yaw, double pitch, double roll) {
  Pose3 pose = Pose3::Identity();
  pose.linear() =
      (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  pose.translation() = Eigen::Vector3d(x, y, z);
  return pose;
}

Pose3 toPose3(const mrpt::poses::CPose3D& pose) {
  return poseFromYpr(pose.x(), pose.y(), pose.z(), pose.yaw(), pose.pitch(), pose.roll());
}

mrpt::poses::CPose3D toMrpt(const Pose3& pose) {
  mrpt::math::CMatrixDouble44 matrix;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) matrix(i, j) = pose.matrix()(i, j);
  return mrpt::poses::CPose3D(matrix);
}

Eigen::Vector3d logSO3(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

Eigen::Matrix3d expSO3(const Eigen::Vector3d& rotation_vector) {
  const double angle = rotation_vector.norm();
  if (angle < 1e-12)
    return Eigen::Quaterniond(1, rotation_vector.x() / 2, rotation_vector.y() / 2, rotation_vector.z() / 2)
        .normalized()
        .toRotationMatrix();
  return Eigen::AngleAxisd(angle, rotation_vector / angle).toRotationMatrix();
}

double rotationAngle(const Pose3& pose) {
  return Eigen::AngleAxisd(pose.linear()).angle();
}

Pose3 interpolate(const Pose3& a, const Pose3& b, double ratio) {
  Pose3 out = Pose3::Identity();
  out.translation() = (1 - ratio) * a.translation() + ratio * b.translation();
  const Eigen::Quaterniond qa(a.linear()), qb(b.linear());
  out.linear() = qa.slerp(ratio, qb).normalized().toRotationMatrix();
  return out;
}

Pose3 normalized(const Pose3& pose) {
  Pose3 out = pose;
  out.linear() = Eigen::Quaterniond(pose.linear()).normalized().toRotationMatrix();
  return out;
}

Eigen::Matrix3d bodyFromOptical() {
  return (Eigen::Matrix3d() << 0, 0, 1, -1, 0, 0, 0, -1, 0).finished();
}

}  // namespace roomgraph
