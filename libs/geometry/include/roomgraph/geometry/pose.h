// SPDX-License-Identifier: BSD-3-Clause
// Rigid transforms in 3D and in the plane: composition, Lie maps, interpolation, conversion to MRPT.
#pragma once

#include <mrpt/poses/CPose3D.h>

#include <Eigen/Geometry>

namespace roomgraph {

/// Rigid transform a_from_b in SE(3).
using Pose3 = Eigen::Isometry3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Rigid transform in the plane: metres, radians in (-pi, pi].
struct Pose2 {
  double x = 0, y = 0, yaw = 0;
  Pose2 operator*(const Pose2& other) const;
  Pose2 inverse() const;
  Eigen::Vector2d operator*(const Eigen::Vector2d& point) const;
};

/// A pose with its time in seconds (Unix epoch, or whatever clock the recording used).
struct StampedPose {
  double t = 0;
  Pose3 pose = Pose3::Identity();
};

double wrapAngle(double radians);  ///< into (-pi, pi]

Pose3 toPose3(const Pose2& pose);     ///< z, roll and pitch are 0
Pose2 planarPart(const Pose3& pose);  ///< x, y, and yaw of the x axis' horizontal direction
Pose3 poseFromYpr(double x, double y, double z, double yaw, double pitch, double roll);
Pose3 toPose3(const mrpt::poses::CPose3D& pose);
mrpt::poses::CPose3D toMrpt(const Pose3& pose);

/// Rotation vector of a rotation matrix, radians.
Eigen::Vector3d logSO3(const Eigen::Matrix3d& rotation);
Eigen::Matrix3d expSO3(const Eigen::Vector3d& rotation_vector);
/// Rotation angle of a pose, radians in [0, pi].
double rotationAngle(const Pose3& pose);
/// Linear in translation, spherical linear in rotation; ratio 0 gives a, 1 gives b.
Pose3 interpolate(const Pose3& a, const Pose3& b, double ratio);
/// With the rotation made orthonormal again, which long products of poses lose.
Pose3 normalized(const Pose3& pose);

/// Rotation robot_from_camera of a camera that looks along the robot's x axis: from optical axes to x forward, z up.
Eigen::Matrix3d bodyFromOptical();

}  // namespace roomgraph
