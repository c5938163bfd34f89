// SPDX-License-Identifier: BSD-3-Clause
// Residuals of points in images, and of landmark box, size and volume, for automatic differentiation.
#pragma once

#include <algorithm>

#include "residuals.h"
#include "roomgraph/geometry/box_sides.h"
#include "roomgraph/geometry/projected_bounds.h"

namespace roomgraph {

// Residuals of points, and of the extent of landmarks. Landmarks are (x, y, z, yaw), sizes (width, depth,
// height), points (x, y, z) in world.

/// Transforms points of world into the optical frame of a camera on a robot.
template <class T>
struct CameraView {
  CameraView(const Pose3& robot_from_camera, const T* t, const T* q)
      : rotation(robot_from_camera.linear().transpose().cast<T>() *
                 Eigen::Map<const Eigen::Quaternion<T>>(q).toRotationMatrix().transpose()),
        position(t),
        lever(robot_from_camera.linear().transpose() * robot_from_camera.translation()) {}

  Vec3<T> see(const Vec3<T>& in_world) const {
    return rotation * (in_world - position) - lever.template cast<T>();
  }

  Mat3<T> rotation;  ///< camera_from_world
  Eigen::Map<const Vec3<T>> position;
  Eigen::Vector3d lever;
};

constexpr double kNear_m = 0.05;  // the camera sees nothing nearer

struct CameraPointResidual {
  explicit CameraPointResidual(const CameraPointFactor& f) : factor(f) {}

  template <class T>
  bool operator()(const T* t, const T* q, const T* point, T* out) const {
    const auto& camera = factor.camera;
    const Vec3<T> p = CameraView<T>(factor.robot_from_camera, t, q).see(Eigen::Map<const Vec3<T>>(point));
    if (p.z() < T(kNear_m)) {
      // Behind the camera: a constant residual as large as the image.
      out[0] = T(camera.width / factor.sigma_px);
      out[1] = T(camera.height / factor.sigma_px);
      out[2] = T(0);
      return true;
    }
    out[0] = (camera.fx * p.x() / p.z() + camera.cx - factor.pixel.x()) / factor.sigma_px;
    out[1] = (camera.fy * p.y() / p.z() + camera.cy - factor.pixel.y()) / factor.sigma_px;
    out[2] = factor.depth_m > 0 ? T((p.z() - factor.depth_m) / factor.sigma_depth_m) : T(0);
    return true;
  }

  CameraPointFactor factor;
};

struct LandmarkBoxResidual {
  LandmarkBoxResidual(const LandmarkBoxFactor& f, ShapeKind shape)
      : factor(f), kind(shape), compared(sidesInside(f.box, f.camera).inOrder()),
        window(windowOf(f.box, f.camera)) {}

  template <class T>
  bool operator()(const T* t, const T* q, const T* landmark, const T* size, T* out) const {
    using std::cos, std::sin;
    const CameraView<T> view(factor.robot_from_camera, t, q);
    const T c = cos(landmark[3]), s = sin(landmark[3]);
    Mat3<T> axes;
    axes << c, -s, T(0), s, c, T(0), T(0), T(0), T(1);
    const Mat3<T> in_camera = view.rotation * axes;
    const Vec3<T> bottom = view.see(Eigen::Map<const Vec3<T>>(landmark));
    auto sides = boundsWithin<T>(window, kind, Eigen::Map<const Vec3<T>>(size), in_camera, bottom, factor.camera, kNear_m);
    if (!sides)  // outside the image: what pulls it back is the whole
      sides = projectedBounds<T>(kind, Eigen::Map<const Vec3<T>>(size), in_camera, bottom, factor.camera, kNear_m);
    const double measured[] = {factor.box.u_min, factor.box.v_min, factor.box.u_max, factor.box.v_max};
    for (std::size_t i = 0; i < 4; ++i) {
      out[i] = T(0);
      if (!compared[i]) continue;
      // Wholly behind the camera: a constant residual as large as the image.
      const double worst = i % 2 == 0 ? factor.camera.width : factor.camera.height;
      out[i] = (sides ? T((*sides)[i] - measured[i]) : T(worst)) / factor.sigma_px;
    }
    return true;
  }

  LandmarkBoxFactor factor;
  ShapeKind kind;
  std::array<bool, 4> compared;
  Box2 window;  // where the image border cut the box, it cuts the model
};

struct PointLandmarkResidual {
  PointLandmarkResidual(const PointLandmarkFactor& f, ShapeKind shape) : factor(f), kind(shape) {}

  template <class T>
  bool operator()(const T* point, const T* landmark, const T* size, T* out) const {
    using std::cos, std::sin;
    const Vec3<T> away = Eigen::Map<const Vec3<T>>(point) - Eigen::Map<const Vec3<T>>(landmark);
    const T c = cos(landmark[3]), s = sin(landmark[3]);
    const Vec3<T> inside(c * away.x() + s * away.y(), c * away.y() - s * away.x(), away.z());
    const auto distance = distanceOutside<T>(kind, Eigen::Map<const Vec3<T>>(size), inside);
    out[0] = distance[0] / factor.sigma_horizontal_m;
    out[1] = distance[1] / factor.sigma_vertical_m;
    return true;
  }

  PointLandmarkFactor factor;
  ShapeKind kind;
};

struct LandmarkSideResidual {
  LandmarkSideResidual(const LandmarkSideFactor& f, ShapeKind shape) : factor(f), kind(shape) {}

  template <class T>
  bool operator()(const T* t, const T* q, const T* landmark, const T* size, T* out) const {
    using std::cos, std::sin;
    const Vec3<T> in_world = Eigen::Map<const Eigen::Quaternion<T>>(q) * factor.point_in_robot.cast<T>() +
                             Eigen::Map<const Vec3<T>>(t);
    const T x = in_world.x() - landmark[0], y = in_world.y() - landmark[1];
    const T c = cos(landmark[3]), s = sin(landmark[3]);
    const Vec3<T> inside(c * x + s * y, c * y - s * x, T(0));
    if (kind == ShapeKind::kCylinder) {
      out[0] = distanceOutside<T>(kind, Eigen::Map<const Vec3<T>>(size), inside)[0] / factor.sigma_m;
      return true;
    }
    const bool lengthwise = std::abs(factor.outward.x()) > 0.5;
    const T half = (lengthwise ? size[1] : size[0]) / 2.0;  // depth along x, width along y
    out[0] = (factor.outward.x() * inside.x() + factor.outward.y() * inside.y() - half) / factor.sigma_m;
    return true;
  }

  LandmarkSideFactor factor;
  ShapeKind kind;
};

struct LandmarkSizeResidual {
  explicit LandmarkSizeResidual(const LandmarkSizeFactor& f) : factor(f) {}

  template <class T>
  bool operator()(const T* size, T* out) const {
    for (int i = 0; i < 3; ++i) {
      out[i] = (size[i] - factor.size_m[i]) / factor.sigma_m[i];
      if (factor.at_least && out[i] > T(0)) out[i] = T(0);
    }
    return true;
  }

  LandmarkSizeFactor factor;
};

}  // namespace roomgraph
