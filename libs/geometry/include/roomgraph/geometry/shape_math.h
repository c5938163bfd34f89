// SPDX-License-Identifier: BSD-3-Clause
// Distance from a shape model and its footprint, as templates for numbers and automatic differentiation.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "roomgraph/geometry/shape.h"

namespace roomgraph {

// Sizes are (width, depth, height) in metres, points in the object frame; see ObjectShape. T is double or a
// type that carries derivatives (ceres::Jet), for which every function avoids the root of zero, which has no
// derivative.

template <class T>
using Vec3 = Eigen::Matrix<T, 3, 1>;
template <class T>
using Mat3 = Eigen::Matrix<T, 3, 3>;

inline Eigen::Vector3d sizeOf(const ObjectShape& shape) {
  return {shape.width, shape.depth, shape.height};
}

template <class T>
T radiusOf(const Vec3<T>& size) {
  return (size[0] + size[1]) / 4.0;
}

template <class T>
T positivePart(const T& value) {
  return value > T(0) ? value : T(0);
}

/// Length of (x, y); 0 without derivatives at the origin.
template <class T>
T lengthOf(const T& x, const T& y) {
  using std::sqrt;
  const T square = x * x + y * y;
  return square > T(0) ? T(sqrt(square)) : T(0);
}

/// How far a coordinate lies outside an interval of this extent around 0, with the coordinate's sign.
template <class T>
T beyondExtent(const T& x, const T& extent) {
  return x < T(0) ? T(-positivePart(T(-x - extent / 2.0))) : positivePart(T(x - extent / 2.0));
}

/// How far a height lies above the model (positive) or below it (negative).
template <class T>
T beyondHeight(const T& z, const T& height) {
  return z < T(0) ? z : positivePart(T(z - height));
}

/// Vector from the nearest point of the model's volume to the point; 0 inside.
template <class T>
Vec3<T> offsetOutside(ShapeKind kind, const Vec3<T>& size, const Vec3<T>& point) {
  const T vertical = beyondHeight(point.z(), size[2]);
  if (kind != ShapeKind::kCylinder)
    return {beyondExtent(point.x(), size[1]), beyondExtent(point.y(), size[0]), vertical};
  const T reach = lengthOf(point.x(), point.y()), radial = positivePart(T(reach - radiusOf(size)));
  if (!(radial > T(0))) return {T(0), T(0), vertical};
  return {radial * point.x() / reach, radial * point.y() / reach, vertical};
}

/// Distance of the point from the model's volume, (horizontal, vertical); 0 inside.
template <class T>
std::array<T, 2> distanceOutside(ShapeKind kind, const Vec3<T>& size, const Vec3<T>& point) {
  const T vertical = beyondHeight(point.z(), size[2]), distance = vertical < T(0) ? T(-vertical) : vertical;
  if (kind == ShapeKind::kCylinder)
    return {positivePart(T(lengthOf(point.x(), point.y()) - radiusOf(size))), distance};
  return {lengthOf(beyondExtent(point.x(), size[1]), beyondExtent(point.y(), size[0])), distance};
}

/// Counter-clockwise, from (1, 0). One of the numbers of corners is kept by each thread: shapes are projected by the thousand.
inline const std::vector<Eigen::Vector2d>& cornersOfUnitCircle(int count) {
  thread_local std::vector<Eigen::Vector2d> corners;
  if (static_cast<int>(corners.size()) != count) {
    corners.clear();
    for (int i = 0; i < count; ++i) {
      const double angle = 2 * std::numbers::pi * i / count;
      corners.emplace_back(std::cos(angle), std::sin(angle));
    }
  }
  return corners;
}

/// Corners of the footprint polygon, counter-clockwise; a circle becomes a polygon of `circle` corners on it.
template <class T>
std::vector<Eigen::Matrix<T, 2, 1>> footprintCorners(ShapeKind kind, const Vec3<T>& size, int circle) {
  if (kind != ShapeKind::kCylinder) {
    const T x = size[1] / 2.0, y = size[0] / 2.0;
    return {{x, -y}, {x, y}, {-x, y}, {-x, -y}};
  }
  std::vector<Eigen::Matrix<T, 2, 1>> corners;
  corners.reserve(static_cast<std::size_t>(circle));
  const T radius = radiusOf(size);
  for (const Eigen::Vector2d& corner : cornersOfUnitCircle(circle)) corners.emplace_back(radius * corner.x(), radius * corner.y());
  return corners;
}

}  // namespace roomgraph
