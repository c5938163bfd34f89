// SPDX-License-Identifier: BSD-3-Clause
// Image bounds of a shape model as a template for numbers and automatic differentiation.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "roomgraph/geometry/camera.h"
#include "roomgraph/geometry/convex_polygon.h"
#include "roomgraph/geometry/shape_math.h"

namespace roomgraph {

/// Bounds of image points in pixels, in the order u_min, v_min, u_max, v_max.
template <class T>
struct ImageBounds {
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

/// Bounds along one image axis (0: u, 1: v) of a circle wholly in front of the camera (camera frame): tangent
/// lines from the dual conic c c' - r^2 (I - n n') of the circle's plane image.
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
  // Width 0 for a circle seen exactly edge-on, where the root has no derivative.
  const T root = under_root > T(1e-18) ? T(sqrt(under_root)) : T(0);
  return {focal * (c02 - root) / c22 + principal, focal * (c02 + root) / c22 + principal};
}

template <class T>
void addCircle(const Vec3<T>& center, const Vec3<T>& normal, const T& radius, const PinholeCamera& camera,
               ImageBounds<T>& bounds) {
  const auto u = circleBounds(center, normal, radius, 0, camera.fx, camera.cx);
  const auto v = circleBounds(center, normal, radius, 1, camera.fy, camera.cy);
  bounds.add(u[0], v[0]);
  bounds.add(u[1], v[1]);
}

/// Calls with an edge's intersection with the near plane, if there is one.
template <class T, class Call>
void forIntersection(const Vec3<T>& p, const Vec3<T>& q, double near_m, const Call& call) {
  if ((p.z() >= T(near_m)) == (q.z() >= T(near_m))) return;
  const T ratio = (T(near_m) - p.z()) / (q.z() - p.z());
  call(Vec3<T>(p + ratio * (q - p)));
}

/// Calls with the corners (camera frame, m) of the part of a model that is in front of the near plane; a cylinder is a
/// prism of 48 sides.
template <class T, class Call>
void forEachSeenCorner(ShapeKind kind, const Vec3<T>& size, const Mat3<T>& axes, const Vec3<T>& bottom, double near_m,
                       const Call& call) {
  constexpr int kCircle = 48;
  const auto corners = footprintCorners(kind, size, kCircle);
  std::vector<Vec3<T>> low, high;
  low.reserve(corners.size());
  high.reserve(corners.size());
  for (const auto& corner : corners) {
    low.push_back(bottom + axes.col(0) * corner.x() + axes.col(1) * corner.y());
    high.push_back(low.back() + size[2] * axes.col(2));
  }
  for (std::size_t i = 0; i < low.size(); ++i) {
    const std::size_t next = (i + 1) % low.size();
    for (const auto* p : {&low[i], &high[i]})
      if (p->z() >= T(near_m)) call(*p);
    forIntersection(low[i], low[next], near_m, call);
    forIntersection(high[i], high[next], near_m, call);
    forIntersection(low[i], high[i], near_m, call);
  }
}

/// Bounds (u_min, v_min, u_max, v_max) of the model's silhouette (paper Eq. 13), not cut by the image border;
/// the object's axes and bottom centre are in the camera frame. The bounds of a cylinder
/// wholly in front of the camera are exact; one that the near plane cuts is approximated by a prism of 48 sides. Edges
/// are clipped at `near_m`; nothing when the whole model is behind it.
template <class T>
std::optional<std::array<T, 4>> projectedBounds(ShapeKind kind, const Vec3<T>& size, const Mat3<T>& axes,
                                                const Vec3<T>& bottom, const PinholeCamera& camera,
                                                double near_m = 0.05) {
  using std::sqrt;
  ImageBounds<T> bounds;
  const Vec3<T> up = axes.col(2), top = bottom + size[2] * up;
  const T radius = radiusOf(size);
  const T level = up.x() * up.x() + up.y() * up.y();
  const T reach = level > T(0) ? T(radius * sqrt(level)) : T(0);
  const T nearest = (top.z() < bottom.z() ? top.z() : bottom.z()) - reach;
  if (kind == ShapeKind::kCylinder && nearest > T(near_m)) {
    addCircle(bottom, up, radius, camera, bounds);
    addCircle(top, up, radius, camera, bounds);
    return bounds.value;
  }
  forEachSeenCorner<T>(kind, size, axes, bottom, near_m, [&](const Vec3<T>& p) { bounds.add(p, camera); });
  if (!bounds.any) return std::nullopt;
  return bounds.value;
}

/// Bounds of the part of the model's silhouette that is inside `window` (px; its sides may be infinite), as
/// projectedBounds(); nothing when no part is. What is nearest, and therefore reaches lowest, is often outside the image:
/// the bounds of the part in view are not those of the whole, cut by the image border. A cylinder that is cut is a
/// prism of 48 sides.
template <class T>
std::optional<std::array<T, 4>> boundsWithin(const Box2& window, ShapeKind kind, const Vec3<T>& size, const Mat3<T>& axes,
                                             const Vec3<T>& bottom, const PinholeCamera& camera, double near_m = 0.05) {
  const auto whole = projectedBounds<T>(kind, size, axes, bottom, camera, near_m);
  if (!whole || ((*whole)[0] >= T(window.u_min) && (*whole)[1] >= T(window.v_min) && (*whole)[2] <= T(window.u_max) &&
                 (*whole)[3] <= T(window.v_max)))
    return whole;
  PlanePolygon<T> points;
  const auto add = [&](const Vec3<T>& p) {
    points.emplace_back(camera.fx * p.x() / p.z() + camera.cx, camera.fy * p.y() / p.z() + camera.cy);
  };
  forEachSeenCorner<T>(kind, size, axes, bottom, near_m, add);
  auto polygon = convexHull<T>(points);
  const auto cut = [&](double u, double v, double along_u, double along_v) {
    if (std::isfinite(u) && std::isfinite(v)) polygon = leftOf<T>(polygon, {T(u), T(v)}, {T(along_u), T(along_v)});
  };
  cut(window.u_min, 0, 0, -1);
  cut(window.u_max, 0, 0, 1);
  cut(0, window.v_min, 1, 0);
  cut(0, window.v_max, -1, 0);
  ImageBounds<T> bounds;
  for (const auto& p : polygon) bounds.add(p.x(), p.y());
  if (!bounds.any) return std::nullopt;
  return bounds.value;
}

}  // namespace roomgraph
