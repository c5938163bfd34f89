// SPDX-License-Identifier: BSD-3-Clause
// Convex hull and clipping of polygons in the plane, as templates for numbers and automatic differentiation.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

namespace roomgraph {

template <class T>
using PlanePolygon = std::vector<Eigen::Matrix<T, 2, 1>>;

/// z component of the cross product: positive when b is to the left of a.
template <class T>
T cross2(const Eigen::Matrix<T, 2, 1>& a, const Eigen::Matrix<T, 2, 1>& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Corners of the convex hull of points, counter-clockwise: the monotone chain (Andrew 1979).
template <class T>
PlanePolygon<T> convexHull(PlanePolygon<T> points) {
  using Point = Eigen::Matrix<T, 2, 1>;
  const auto same = [](const Point& a, const Point& b) { return a.x() == b.x() && a.y() == b.y(); };
  std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  points.erase(std::unique(points.begin(), points.end(), same), points.end());
  if (points.size() < 3) return points;
  PlanePolygon<T> hull;
  const auto sweep = [&](auto begin, auto end) {  // the lower hull from the left, the upper one from the right
    const std::size_t base = hull.size();
    for (auto it = begin; it != end; ++it) {
      while (hull.size() >= base + 2 && cross2<T>(hull.back() - hull[hull.size() - 2], *it - hull[hull.size() - 2]) <= T(0))
        hull.pop_back();
      hull.push_back(*it);
    }
    hull.pop_back();
  };
  sweep(points.begin(), points.end());
  sweep(points.rbegin(), points.rend());
  return hull;
}

/// The part of a convex polygon to the left of the line through `from` along `along` (Sutherland and Hodgman 1974).
template <class T>
PlanePolygon<T> leftOf(const PlanePolygon<T>& polygon, const Eigen::Matrix<T, 2, 1>& from, const Eigen::Matrix<T, 2, 1>& along) {
  PlanePolygon<T> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const auto &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const T side_p = cross2<T>(along, p - from), side_q = cross2<T>(along, q - from);
    if (side_p >= T(0)) kept.push_back(p);
    if (side_p * side_q < T(0)) kept.push_back(p + (q - p) * side_p / (side_p - side_q));
  }
  return kept;
}

}  // namespace roomgraph
