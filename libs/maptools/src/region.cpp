// SPDX-License-Identifier: BSD-3-Clause
// Crossing test, distance to edges, and a grid for maps without one.
#include "region.h"

#include <limits>

#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

constexpr double kMargin_m = 1, kCell_m = 0.05;  // of a grid around objects and path

double distanceToEdge(const Eigen::Vector2d& point, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const double length2 = along.squaredNorm();
  const double ratio = length2 > 0 ? std::clamp((point - a).dot(along) / length2, 0.0, 1.0) : 0;
  return (point - a - ratio * along).norm();
}

}  // namespace

bool contains(const Polygon2& polygon, const Eigen::Vector2d& point) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const auto &a = polygon[i], &b = polygon[j];
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    if (point.x() < a.x() + (b.x() - a.x()) * (point.y() - a.y()) / (b.y() - a.y())) inside = !inside;
  }
  return inside;
}

double distanceTo(const Polygon2& polygon, const Eigen::Vector2d& point) {
  if (contains(polygon, point)) return 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++)
    nearest = std::min(nearest, distanceToEdge(point, polygon[i], polygon[j]));
  return nearest;
}

Eigen::AlignedBox2d boundsOf(const Polygon2& polygon) {
  Eigen::AlignedBox2d box;
  for (const auto& corner : polygon) box.extend(corner);
  return box;
}

Polygon2 footprintOf(const Landmark& landmark) {
  return footprintAt({landmark.position.x(), landmark.position.y(), landmark.yaw}, landmark.shape);
}

mrpt::maps::COccupancyGridMap2D gridOf(const CSemanticMap& map) {
  if (map.occupancy) return *map.occupancy;
  Eigen::AlignedBox2d box;
  for (const auto& landmark : map.landmarks) box.extend(boundsOf(footprintOf(landmark)));
  for (const auto& stamped : map.world_from_robot)
    box.extend(Eigen::Vector2d(stamped.pose.translation().head<2>()));
  if (box.isEmpty()) throw RunError("the map is empty: it has neither grid nor objects nor path");
  mrpt::maps::COccupancyGridMap2D grid(
      static_cast<float>(box.min().x() - kMargin_m), static_cast<float>(box.max().x() + kMargin_m),
      static_cast<float>(box.min().y() - kMargin_m), static_cast<float>(box.max().y() + kMargin_m),
      static_cast<float>(kCell_m));
  grid.fill(0.5f);
  return grid;
}

}  // namespace roomgraph
