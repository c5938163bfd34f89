// SPDX-License-Identifier: BSD-3-Clause
// Residuals of the calibration problem, in standard deviations, for Ceres' automatic derivatives.
#pragma once

#include <ceres/rotation.h>

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "sensor_model.h"
#include "wall_matches.h"

namespace roomgraph {

/// Movement of the robot by its wheels from one reading over others to a last one, against that of the lidar.
/// The times are those of readings: of movements with independent errors, those in between would share some.
struct WheelMovement {
  const PlanarPath* lidar;
  double t_a, t_b;
  std::vector<PlanarValues<double>> read;  ///< from reading to reading

  /// Lidar minus wheels: forward, sideways, turn. `offset_s` is added to the stamps of the wheels.
  template <class T>
  PlanarValues<T> difference(const T* p, const T& offset_s) const {
    const PlanarValues<T> by_lidar =
        robotMovement(p, planarBetween(lidar->at(T(t_a + offset_s)), lidar->at(T(t_b + offset_s))));
    PlanarValues<T> by_wheels{T(0), T(0), T(0)};
    for (const auto& step : read)
      by_wheels =
          planarProduct(by_wheels, correctedMovement(p, PlanarValues<T>{T(step[0]), T(step[1]), T(step[2])}));
    return {by_lidar[0] - by_wheels[0], by_lidar[1] - by_wheels[1], by_lidar[2] - by_wheels[2]};
  }
};

/// Beginnings and ends of a drive say what the time offset is, as those of turns do.
struct WheelMoveCost {
  WheelMovement movement;
  double sigma_forward_m, sigma_side_m;

  template <class T>
  bool operator()(const T* p, T* residuals) const {
    const auto off = movement.difference(p, p[kWheelTime]);
    residuals[0] = off[0] / sigma_forward_m;
    residuals[1] = off[1] / sigma_side_m;
    return true;
  }
};

struct WheelTurnCost {
  WheelMovement movement;
  double sigma_rad;

  template <class T>
  bool operator()(const T* p, T* residuals) const {
    residuals[0] = movement.difference(p, p[kWheelTime])[2] / sigma_rad;
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

/// Height of a patch of floor, which is zero; in metres as the camera measures them, so that no smaller scale makes it
/// smaller.
struct FloorCost {
  DepthPatch patch;
  double sigma_m;

  template <class T>
  bool operator()(const T* p, T* residuals) const {
    residuals[0] = patchOnRobot(p, patch).z() / ((p[kDepthScale] + p[kDepthBias] / patch.point.z()) * sigma_m);
    return true;
  }
};

/// Movement of the robot by the lidar between two times of images. Only the angle depends on the time offset: of the speed
/// that the curve has at an instant, noise is too large a part to tell it from.
template <class T>
PlanarValues<T> movementBetweenImages(const T* p, const PlanarPath& lidar, double t_a, double t_b, double offset_s) {
  const PlanarValues<double> before = lidar.at(t_a + offset_s), after = lidar.at(t_b + offset_s);
  PlanarValues<T> moved = planarBetween(PlanarValues<T>{T(before[0]), T(before[1]), T(before[2])},
                                        PlanarValues<T>{T(after[0]), T(after[1]), T(after[2])});
  moved[2] = lidar.at(T(t_b + p[kCameraTime]))[2] - lidar.at(T(t_a + p[kCameraTime]))[2];
  return robotMovement(p, moved);
}

/// Six residuals: of a turn, which should be none, and of a gap, which should be none either, times the roots of their
/// information.
template <class T>
void weigh(const Matrix3T<T>& turn, const Vector3T<T>& gap, const Eigen::Matrix3d& per_rad, const Eigen::Matrix3d& per_m,
           T* residuals) {
  Vector3T<T> angles;
  ceres::RotationMatrixToAngleAxis(turn.data(), angles.data());
  Eigen::Map<Eigen::Matrix<T, 6, 1>> out(residuals);
  out << per_rad.cast<T>() * angles, per_m.cast<T>() * gap;
}

/// Hand-eye equation A X = X B (Tsai and Lenz 1989): movement of the camera by visual odometry against that
/// of the robot by the lidar. Turn (3), then movement (3), in the earlier camera's frame and in metres as that measures
/// them: its noise must not be scaled down.
struct CameraStepCost {
  const PlanarPath* reference;
  CameraStep step;
  double offset_s;  ///< found so far
  double sigma_rad, sigma_m;

  template <class T>
  bool operator()(const T* p, T* residuals) const {
    const PlanarValues<T> robot = movementBetweenImages(p, *reference, step.t_a, step.t_b, offset_s);
    const Matrix3T<T> mounted = cameraRotation(p);
    const Vector3T<T> place = cameraPlace(p), moved(robot[0], robot[1], T(0));
    const Matrix3T<T> turn = Eigen::AngleAxis<T>(robot[2], Vector3T<T>::UnitZ()).toRotationMatrix();
    const Matrix3T<T> off =
        step.a_from_b.linear().transpose().cast<T>() * mounted.transpose() * turn * mounted;
    const T scale = p[kDepthScale] + p[kDepthBias] / step.depth_m;
    const Vector3T<T> gap =
        mounted.transpose() * (turn * place + moved - place) / scale - step.a_from_b.translation().cast<T>();
    const Eigen::Matrix3d unit = Eigen::Matrix3d::Identity();
    weigh(off, gap, unit / sigma_rad, unit / sigma_m, residuals);
    return true;
  }
};

/// A board that stands still, seen in two images: where the later one shows it against where the robot's movement by the
/// lidar has it from the earlier one. Turn (3) in the board's frame, then its middle (3) in the later camera's.
struct BoardCost {
  const PlanarPath* lidar;
  BoardView before, after;
  double offset_s;                  ///< found so far
  Eigen::Matrix3d per_rad, per_m;  ///< roots of information

  template <class T>
  bool operator()(const T* p, T* residuals) const {
    const PlanarValues<T> robot = movementBetweenImages(p, *lidar, before.t, after.t, offset_s);
    const Matrix3T<T> mounted = cameraRotation(p);
    const Vector3T<T> place = cameraPlace(p), moved(robot[0], robot[1], T(0));
    const Matrix3T<T> turned_back =
        Eigen::AngleAxis<T>(-robot[2], Vector3T<T>::UnitZ()).toRotationMatrix();
    const Vector3T<T> on_robot = mounted * before.camera_from_board.translation().cast<T>() + place;
    const Vector3T<T> gap = mounted.transpose() * (turned_back * (on_robot - moved) - place) -
                            after.camera_from_board.translation().cast<T>();
    const Matrix3T<T> off = after.camera_from_board.linear().transpose().cast<T>() * mounted.transpose() *
                            turned_back * mounted * before.camera_from_board.linear().cast<T>();
    weigh(off, gap, per_rad, per_m, residuals);
    return true;
  }
};

/// Distance of the depth measured on a board from the plane that its corners say it has.
struct BoardDepthCost {
  BoardView view;  ///< with depth
  double sigma_m;

  template <class T>
  bool operator()(const T* p, T* residuals) const {
    const Eigen::Vector3d normal = view.camera_from_board.linear().col(2);
    const Vector3T<T> seen =
        p[kDepthScale] * view.depth->point.cast<T>() + p[kDepthBias] * view.depth->ray.cast<T>();
    residuals[0] = (normal.cast<T>().dot(seen) - normal.dot(view.camera_from_board.translation())) / sigma_m;
    return true;
  }
};

}  // namespace roomgraph
