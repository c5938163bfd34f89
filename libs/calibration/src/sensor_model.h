// SPDX-License-Identifier: BSD-3-Clause
// Where the parameters of a calibration put sensors and what they measured; for doubles and for Ceres' jets.
#pragma once

#include <Eigen/Geometry>

#include "evidence.h"
#include "planar_path.h"
#include "roomgraph/calibration/sensor_parameters.h"
#include "roomgraph/geometry/pose.h"

namespace roomgraph {

template <class T>
using Vector3T = Eigen::Matrix<T, 3, 1>;
template <class T>
using Matrix3T = Eigen::Matrix<T, 3, 3>;

/// Rotation by yaw, pitch and roll about z, y and x in turn, as MRPT has it.
template <class T>
Matrix3T<T> rotationFromYpr(const T& yaw, const T& pitch, const T& roll) {
  using V = Vector3T<T>;
  return (Eigen::AngleAxis<T>(yaw, V::UnitZ()) * Eigen::AngleAxis<T>(pitch, V::UnitY()) *
          Eigen::AngleAxis<T>(roll, V::UnitX()))
      .toRotationMatrix();
}

/// Rotation robot_from_camera, optical axes.
template <class T>
Matrix3T<T> cameraRotation(const T* p) {
  return rotationFromYpr(p[kCameraYaw], p[kCameraPitch], p[kCameraRoll]) * bodyFromOptical().cast<T>();
}

template <class T>
Vector3T<T> cameraPlace(const T* p) {
  return {p[kCameraX], p[kCameraY], p[kCameraZ]};
}

template <class T>
PlanarValues<T> robotFromLidar(const T* p) {
  return {p[kLidarX], p[kLidarY], p[kLidarYaw]};
}

/// The mean of a patch with its depths corrected, in the robot's frame.
template <class T>
Vector3T<T> patchOnRobot(const T* p, const DepthPatch& patch) {
  const Vector3T<T> seen = p[kDepthScale] * patch.point.cast<T>() + p[kDepthBias] * patch.ray.cast<T>();
  return cameraRotation(p) * seen + cameraPlace(p);
}

/// A point of the robot's frame in the horizontal frame of the lidar.
template <class T>
Eigen::Matrix<T, 2, 1> inLidar(const T* p, const Vector3T<T>& on_robot) {
  using std::cos;
  using std::sin;
  const T c = cos(p[kLidarYaw]), s = sin(p[kLidarYaw]), x = on_robot.x() - p[kLidarX],
          y = on_robot.y() - p[kLidarY];
  return {c * x + s * y, c * y - s * x};
}

/// Movement of the robot from that of the lidar.
template <class T>
PlanarValues<T> robotMovement(const T* p, const PlanarValues<T>& of_lidar) {
  const PlanarValues<T> lidar = robotFromLidar(p), origin{T(0), T(0), T(0)};
  return planarProduct(planarProduct(lidar, of_lidar), planarBetween(lidar, origin));
}

/// sin(a / 2) / (a / 2), the chord of an arc over its length.
template <class T>
T chordShare(const T& angle) {
  using std::sin;
  const T h = angle / 2.0;
  return std::abs(scalarOf(h)) < 1e-3 ? T(1.0 - h * h / 6.0) : T(sin(h) / h);
}

/// A movement of the robot by wheel odometry, corrected as WheelCorrection says.
template <class T>
PlanarValues<T> correctedMovement(const T* p, const PlanarValues<T>& read) {
  using std::cos;
  using std::sin;
  const T half = read[2] / 2.0;
  const T along = cos(half) * read[0] + sin(half) * read[1],
          aside = cos(half) * read[1] - sin(half) * read[0];
  const T length = p[kWheelScale] * along / chordShare(read[2]);
  const T turn = p[kTurnScale] * read[2] + p[kHeadingDrift] * length;
  const T chord = length * chordShare(turn), new_aside = p[kWheelScale] * aside;
  const T c = cos(turn / 2.0), s = sin(turn / 2.0);
  return {c * chord - s * new_aside, s * chord + c * new_aside, turn};
}

}  // namespace roomgraph
