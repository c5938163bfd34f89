// SPDX-License-Identifier: BSD-3-Clause
// The convex hull against brute force, and clipping against points that are sampled.
#include "roomgraph/geometry/convex_polygon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "roomgraph/core/random.h"

namespace roomgraph {
namespace {

using Point = Eigen::Vector2d;

double cross(const Point& o, const Point& a, const Point& b) {
  return (a - o).x() * (b - o).y() - (a - o).y() * (b - o).x();
}

/// By definition: a point is a corner of the hull when no triangle and no segment of other points contains it.
bool isCorner(const std::vector<Point>& points, std::size_t i) {
  for (std::size_t a = 0; a < points.size(); ++a)
    for (std::size_t b = 0; b < points.size(); ++b)
      for (std::size_t c = 0; c < points.size(); ++c) {
        if (a == i || b == i || c == i || a == b) continue;
        const double u = cross(points[a], points[b], points[i]), v = cross(points[b], points[c], points[i]),
                     w = cross(points[c], points[a], points[i]);
        const bool flat = cross(points[a], points[b], points[c]) == 0;
        const Point between = (points[a] - points[i]).cwiseProduct(points[b] - points[i]);
        if (!flat && u >= 0 && v >= 0 && w >= 0) return false;
        if (flat && u == 0 && between.maxCoeff() <= 0) return false;
      }
  return true;
}

TEST(ConvexHull, HasTheCornersThatBruteForceFinds) {
  Random random(11);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Point> points;
    for (int i = 0; i < 14; ++i)  // on a coarse lattice, so that many are collinear
      points.emplace_back(std::floor(random.uniform(0, 6)), std::floor(random.uniform(0, 6)));
    std::sort(points.begin(), points.end(),
              [](const Point& a, const Point& b) { return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y()); });
    points.erase(std::unique(points.begin(), points.end()), points.end());
    const auto hull = convexHull<double>(points);
    std::size_t corners = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const bool found = std::find(hull.begin(), hull.end(), points[i]) != hull.end();
      EXPECT_EQ(found, isCorner(points, i)) << points[i].transpose();
      corners += found;
    }
    EXPECT_EQ(hull.size(), corners);
    for (std::size_t i = 0; i < hull.size(); ++i)
      EXPECT_GT(cross(hull[i], hull[(i + 1) % hull.size()], hull[(i + 2) % hull.size()]), 0) << "not ccw";
  }
}

TEST(ConvexHull, RepeatedPointsCountOnce) {
  EXPECT_EQ(convexHull<double>({{1, 2}, {1, 2}, {3, 4}, {1, 2}}), (std::vector<Point>{{1, 2}, {3, 4}}));
  EXPECT_TRUE(convexHull<double>({}).empty());
}

bool contains(const std::vector<Point>& polygon, const Point& p) {
  for (std::size_t i = 0; i < polygon.size(); ++i)
    if (cross(polygon[i], polygon[(i + 1) % polygon.size()], p) < 0) return false;
  return polygon.size() > 2;
}

TEST(ConvexPolygon, LeftOfALineIsWhatIsInBoth) {
  Random random(12);
  int kept = 0, lost = 0;
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<Point> points;
    for (int i = 0; i < 9; ++i) points.emplace_back(random.uniform(-1, 1), random.uniform(-1, 1));
    const auto polygon = convexHull<double>(points);
    const Point from(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5)), along(random.uniform(-1, 1), random.uniform(-1, 1));
    const auto left = leftOf<double>(polygon, from, along);
    for (int i = 0; i < 200; ++i) {
      const Point p(random.uniform(-1, 1), random.uniform(-1, 1));
      if (!contains(polygon, p)) continue;
      const bool is_left = cross(from, from + along, p) >= 0;
      EXPECT_EQ(contains(left, p), is_left);
      (is_left ? kept : lost)++;
    }
    for (const Point& corner : left) EXPECT_GE(cross(from, from + along, corner), -1e-12);
  }
  EXPECT_GT(kept, 500);
  EXPECT_GT(lost, 500);
}

}  // namespace
}  // namespace roomgraph
