// SPDX-License-Identifier: BSD-3-Clause
// Image bounds of an object model, templated for automatic differentiation.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "roomgraph/geometry/camera.h"
#include "roomgraph/geometry/shape.h"

namespace roomgraph {

// The image bounds of a model (paper Eq. 13) as a template, so that automatic differentiation sees through
// them: the same definition as geometry's projectShape, which is for plain numbers; a test compares the two.

template <class T>
using Vec3 = Eigen::Matrix<T, 3, 1>;
template <class T>
using Mat3 = Eigen::Matrix<T, 3, 3>;

/// Bounds in pixels that grow with every point: u_min, v_min, u_max, v_max.
template <class T>
struct Sides {
  std::array<T, 4> value;
  bool any = false;

  void add(const T& u, const T& v) {
    if (!any || u < value[0]) value[0] = u;
    if (!any || v < value[1]) value[1] = v;
    if (!any || u > value[2]) value[2] = u;
    if (!any || v > value[3]) value[3] = v;
    any = true;
  }
  void add(const Vec3<T>& p, const PinholeCamera& camera) {
    add(camera.fx * p.x() / p.z() + camera.cx, camera.fy * p.y() / p.z() + camera.cy);
  }
};

/// Bounds of one image axis of a circle wholly in front of the camera, from its dual conic c c' - r^2 (I - n
/// n') (adjugate).
template <class T>
std::array<T, 2> circleBounds(const Vec3<T>& center, const Vec3<T>& normal, const T& radius, int axis,
                              double focal, double principal) {
  using std::sqrt;
  const T square = radius * radius;
  const auto dual = [&](int i, int j) {
    return T(center[i] * center[j] - square * (T(i == j ? 1 : 0) - normal[i] * normal[j]));
  };
  const T c22 = dual(2, 2), c02 = dual(axis, 2), c00 = dual(axis, axis);
  const T under_root = c02 * c02 - c22 * c00;
  // A circle seen exactly edge-on: its width along this axis is 0, and the root has no derivative there.
  const T root = under_root > T(1e-18) ? T(sqrt(under_root)) : T(0);
  return {focal * (c02 - root) / c22 + principal, focal * (c02 + root) / c22 + principal};
}

template <class T>
void addCircle(const Vec3<T>& center, const Vec3<T>& normal, const T& radius, const PinholeCamera& camera,
               Sides<T>& sides) {
  const auto u = circleBounds(center, normal, radius, 0, camera.fx, camera.cx);
  const auto v = circleBounds(center, normal, radius, 1, camera.fy, camera.cy);
  sides.add(u[0], v[0]);
  sides.add(u[1], v[1]);
}

template <class T>
void addClippedEdge(const Vec3<T>& p, const Vec3<T>& q, const PinholeCamera& camera, double near_m,
                    Sides<T>& sides) {
  const bool p_seen = p.z() >= T(near_m), q_seen = q.z() >= T(near_m);
  if (p_seen) sides.add(p, camera);
  if (p_seen == q_seen) return;
  const T ratio = (T(near_m) - p.z()) / (q.z() - p.z());
  sides.add(Vec3<T>(p + ratio * (q - p)), camera);
}

/// Corners of the footprint; size = (width, depth, height). A circle becomes a polygon of 48 corners.
template <class T>
std::vector<Eigen::Matrix<T, 2, 1>> footprintCorners(ShapeKind kind, const Vec3<T>& size) {
  std::vector<Eigen::Matrix<T, 2, 1>> corners;
  if (kind != ShapeKind::kCylinder) {
    const T x = size[1] / 2.0, y = size[0] / 2.0;
    return {{x, -y}, {x, y}, {-x, y}, {-x, -y}};
  }
  constexpr int kCorners = 48;
  const T radius = (size[0] + size[1]) / 4.0;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2 * M_PI * i / kCorners;
    corners.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return corners;
}

/// Bounds (u_min, v_min, u_max, v_max) of a model's image, not cut by the image border; the object's axes and
/// bottom centre are in the camera frame. Edges are clipped at `near_m`; nothing when all of it is behind.
template <class T>
std::optional<std::array<T, 4>> projectedSides(ShapeKind kind, const Vec3<T>& size, const Mat3<T>& axes,
                                               const Vec3<T>& bottom, const PinholeCamera& camera,
                                               double near_m = 0.05) {
  using std::sqrt;
  Sides<T> sides;
  const Vec3<T> up = axes.col(2), top = bottom + size[2] * up;
  const T radius = (size[0] + size[1]) / 4.0;
  const T level = up.x() * up.x() + up.y() * up.y();
  const T reach = level > T(0) ? T(radius * sqrt(level)) : T(0);
  const T nearest = (top.z() < bottom.z() ? top.z() : bottom.z()) - reach;
  if (kind == ShapeKind::kCylinder && nearest > T(near_m)) {
    addCircle(bottom, up, radius, camera, sides);
    addCircle(top, up, radius, camera, sides);
    return sides.value;
  }
  std::vector<Vec3<T>> low, high;
  for (const auto& corner : footprintCorners(kind, size)) {
    low.push_back(bottom + axes.col(0) * corner.x() + axes.col(1) * corner.y());
    high.push_back(low.back() + size[2] * up);
  }
  for (std::size_t i = 0; i < low.size(); ++i) {
    const std::size_t next = (i + 1) % low.size();
    addClippedEdge(low[i], low[next], camera, near_m, sides);
    addClippedEdge(high[i], high[next], camera, near_m, sides);
    addClippedEdge(low[i], high[i], camera, near_m, sides);
  }
  if (!sides.any) return std::nullopt;
  return sides.value;
}

}  // namespace roomgraph
