// SPDX-License-Identifier: BSD-3-Clause
// Outlines of cells of a grid as polygons.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace roomgraph {

using Polygon2 = std::vector<Eigen::Vector2d>;

/// Cells hold the probability of being free. The limit of occupied ones is map_server's; free ones of map_server are
/// surer (.804).
inline bool isOccupiedCell(float p_free) {
  return p_free < 0.35f;
}
inline bool isFreeCell(float p_free) {
  return p_free > 0.65f;
}

/// Borders of the cells that `chosen` takes, in world: closed polygons, counter-clockwise around cells and
/// clockwise around holes, along the cells' sides. Cells that touch at a corner only are apart.
std::vector<Polygon2> outlinesOf(const mrpt::maps::COccupancyGridMap2D& grid,
                                 const std::function<bool(float p_free)>& chosen);

/// Distance that straightens the steps of oblique walls and keeps walls of one cell, m.
double outlineTolerance(const mrpt::maps::COccupancyGridMap2D& grid);
/// Closed polygons without corners that lie within `tolerance_m` of what remains (Douglas and Peucker); those
/// that would shrink to a line stay as they are.
std::vector<Polygon2> simplified(const std::vector<Polygon2>& polygons, double tolerance_m);

}  // namespace roomgraph
