// SPDX-License-Identifier: BSD-3-Clause
// Convex hull and clipping of polygons in the plane, as templates for numbers and automatic differentiation.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <numeric>
#include <tuple>
#include <vector>

namespace roomgraph {

template <class T>
using PlanePolygon = std::vector<Eigen::Matrix<T, 2, 1>>;

/// z component of the cross product: positive when b is to the left of a.
template <class T>
T cross2(const Eigen::Matrix<T, 2, 1>& a, const Eigen::Matrix<T, 2, 1>& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// The number itself, of one that carries derivatives (ceres::Jet).
inline double valueOf(double number) { return number; }
template <class Jet>
double valueOf(const Jet& number) {
  return number.a;
}
template <class T>
Eigen::Vector2d valueOf(const Eigen::Matrix<T, 2, 1>& point) {
  return {valueOf(point.x()), valueOf(point.y())};
}

/// Which points are the corners of their convex hull, counter-clockwise: the monotone chain (Andrew 1979). Of equal points
/// the first.
inline std::vector<int> convexHullOf(const std::vector<Eigen::Vector2d>& points) {
  std::vector<int> order(points.size()), hull;
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return std::tuple(points[a].x(), points[a].y(), a) < std::tuple(points[b].x(), points[b].y(), b);
  });
  order.erase(std::unique(order.begin(), order.end(), [&](int a, int b) { return points[a] == points[b]; }), order.end());
  if (order.size() < 3) return order;
  const auto sweep = [&](auto begin, auto end) {  // the lower hull from the left, the upper one from the right
    const std::size_t base = hull.size();
    const auto left = [&](int to) {
      const Eigen::Vector2d& from = points[hull[hull.size() - 2]];
      return cross2<double>(points[hull.back()] - from, points[to] - from) > 0;
    };
    for (auto it = begin; it != end; ++it) {
      while (hull.size() >= base + 2 && !left(*it)) hull.pop_back();
      hull.push_back(*it);
    }
    hull.pop_back();
  };
  sweep(order.begin(), order.end());
  sweep(order.rbegin(), order.rend());
  return hull;
}

/// Corners of the convex hull of points, counter-clockwise. Which they are is decided without their derivatives.
template <class T>
PlanePolygon<T> convexHull(const PlanePolygon<T>& points) {
  std::vector<Eigen::Vector2d> values;
  values.reserve(points.size());
  for (const auto& point : points) values.push_back(valueOf(point));
  PlanePolygon<T> hull;
  for (const int i : convexHullOf(values)) hull.push_back(points[i]);
  return hull;
}

/// The part of a convex polygon to the left of the line through `from` along `along` (Sutherland and Hodgman 1974).
template <class T>
PlanePolygon<T> leftOf(const PlanePolygon<T>& polygon, const Eigen::Matrix<T, 2, 1>& from, const Eigen::Matrix<T, 2, 1>& along) {
  PlanePolygon<T> kept;
  const auto side = [&](const auto& point) { return cross2<T>(along, point - from); };
  const auto value = [&](const auto& point) { return cross2<double>(valueOf(along), valueOf(point) - valueOf(from)); };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const auto &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double value_p = value(p), value_q = value(q);
    if (value_p >= 0) kept.push_back(p);
    if (value_p * value_q >= 0) continue;
    const T side_p = side(p), side_q = side(q);
    kept.push_back(p + (q - p) * side_p / (side_p - side_q));
  }
  return kept;
}

}  // namespace roomgraph
