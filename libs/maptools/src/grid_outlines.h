// SPDX-License-Identifier: BSD-3-Clause
// Outlines of cells of a grid as polygons.
#pragma once

#include <functional>

#include "region.h"

namespace roomgraph {

/// Borders of the cells that `chosen` takes, in world: closed polygons, counter-clockwise around cells and
/// clockwise around holes, along the cells' sides. Cells that touch at a corner only are apart.
std::vector<Polygon2> outlinesOf(const mrpt::maps::COccupancyGridMap2D& grid,
                                 const std::function<bool(float p_free)>& chosen);

/// Closed polygons without corners that lie within `tolerance_m` of what remains (Douglas and Peucker); those
/// that shrink to a line are left out.
std::vector<Polygon2> simplified(const std::vector<Polygon2>& polygons, double tolerance_m);

}  // namespace roomgraph
