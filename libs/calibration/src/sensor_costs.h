// SPDX-License-Identifier: BSD-3-Clause
// Residuals of the calibration problem, in standard deviations, for Ceres' automatic derivatives.
#pragma once

#include <ceres/rotation.h>

#include <Eigen/Geometry>

#include "sensor_model.h"
#include "wall_matches.h"
#include "wheel_movements.h"

namespace roomgraph {

// Of wheels and lidar, the wheels err more by far. Their residuals are errors of their readings, so by the
// scale that corrects these: errors of what they measure, after correction, would be least with scales that
// are too small.

/// Place after a movement. The time offset is the one found so far: of the speed that the curve has at an
/// instant, noise is too large a part to tell it from.
struct WheelMoveCost {
  WheelMovement movement;
  Eigen::Matrix2d whitening;  ///< gives the difference of places standard deviation 1 along each row

  template <class T>
  bool operator()(const T* p, T* residuals) const {
    const Eigen::Matrix<T, 2, 1> off = whitening.cast<T>() * movement.placeDifference(p);
    residuals[0] = off.x() / p[kWheelScale];
    residuals[1] = off.y() / p[kWheelScale];
    return true;
  }
};

struct WheelTurnCost {
  WheelMovement movement;
  double sigma_rad;

  template <class T>
  bool operator()(const T* p, T* residuals) const {
    residuals[0] = movement.turnDifference(p, p[kWheelTime]) / (sigma_rad * p[kTurnScale]);
    return true;
  }
};

/// Distance of a depth patch to the wall that the lidar saw.
struct WallCost {
  const PlanarPath* lidar;
  WallMatch match;
  double sigma_m;

  template <class T>
  bool operator()(const T* p, T* residuals) const {
    const PlanarValues<double> at_scan = lidar->at(match.scan_t);
    const PlanarValues<T> scan{T(at_scan[0]), T(at_scan[1]), T(at_scan[2])};
    const PlanarValues<T> moved = planarBetween(scan, lidar->at(T(match.view_t + p[kCameraTime])));
    const Eigen::Matrix<T, 2, 1> in_view = inLidar(p, patchOnRobot(p, match.patch));
    const T c = cos(moved[2]), s = sin(moved[2]);
    const T x = moved[0] + c * in_view.x() - s * in_view.y(),
            y = moved[1] + s * in_view.x() + c * in_view.y();
    residuals[0] = (match.wall.normal.x() * x + match.wall.normal.y() * y - match.wall.distance_m) / sigma_m;
    return true;
  }
};

/// Height of a patch of floor, which is zero.
struct FloorCost {
  DepthPatch patch;
  double sigma_m;

  template <class T>
  bool operator()(const T* p, T* residuals) const {
    residuals[0] = patchOnRobot(p, patch).z() / sigma_m;
    return true;
  }
};

/// Hand-eye equation A X = X B (Tsai and Lenz 1989): movement of the camera by visual odometry against that
/// of the robot by the lidar. Turn (3), then movement (3), in the
/// earlier camera's frame. Only the angle depends on the time offset, as for wheels.
struct CameraStepCost {
  const PlanarPath* reference;
  CameraStep step;
  double offset_s;  ///< found so far
  double sigma_rad, sigma_m;

  template <class T>
  bool operator()(const T* p, T* residuals) const {
    const PlanarValues<double> before = reference->at(step.t_a + offset_s),
                               after = reference->at(step.t_b + offset_s);
    PlanarValues<T> robot = planarBetween(PlanarValues<T>{T(before[0]), T(before[1]), T(before[2])},
                                          PlanarValues<T>{T(after[0]), T(after[1]), T(after[2])});
    robot[2] =
        reference->at(T(step.t_b + p[kCameraTime]))[2] - reference->at(T(step.t_a + p[kCameraTime]))[2];
    robot = robotMovement(p, robot);
    const Matrix3T<T> mounted = cameraRotation(p);
    const Vector3T<T> place = cameraPlace(p), moved(robot[0], robot[1], T(0));
    const Matrix3T<T> turn = Eigen::AngleAxis<T>(robot[2], Vector3T<T>::UnitZ()).toRotationMatrix();
    const Matrix3T<T> off =
        step.a_from_b.linear().transpose().cast<T>() * mounted.transpose() * turn * mounted;
    const T scale = p[kDepthScale] + p[kDepthBias] / step.depth_m;
    const Vector3T<T> gap =
        mounted.transpose() * (turn * place + moved - place) - scale * step.a_from_b.translation().cast<T>();
    T angles[3];
    ceres::RotationMatrixToAngleAxis(off.data(), angles);
    for (int k = 0; k < 3; ++k) {
      residuals[k] = angles[k] / sigma_rad;
      residuals[3 + k] = gap[k] / sigma_m;
    }
    return true;
  }
};

}  // namespace roomgraph
