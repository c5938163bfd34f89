// SPDX-License-Identifier: BSD-3-Clause
// Polygons on a grid: point in polygon, distance, cells, meaning of a cell.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "roomgraph/maptools/grid_outlines.h"
#include "roomgraph/observations/CSemanticMap.h"

namespace roomgraph {

/// By crossings of a ray; the polygon may be concave.
bool contains(const Polygon2& polygon, const Eigen::Vector2d& point);
/// From a point to the polygon, 0 inside.
double distanceTo(const Polygon2& polygon, const Eigen::Vector2d& point);
Eigen::AlignedBox2d boundsOf(const Polygon2& polygon);
/// Of a landmark, in world, counter-clockwise.
Polygon2 footprintOf(const Landmark& landmark);

inline Eigen::Vector2d cellCentre(const mrpt::maps::COccupancyGridMap2D& grid, int x, int y) {
  const double cell = static_cast<double>(grid.getResolution());
  return {static_cast<double>(grid.getXMin()) + (x + 0.5) * cell,
          static_cast<double>(grid.getYMin()) + (y + 0.5) * cell};
}

/// Calls visit(x, y) for every cell of the grid whose centre is at most `margin` from the polygon.
template <class Visit>
void forCellsNear(const mrpt::maps::COccupancyGridMap2D& grid, const Polygon2& polygon, double margin,
                  const Visit& visit) {
  const auto box = boundsOf(polygon);
  const auto index = [&](double along, double low, unsigned count) {
    const double cell = std::floor((along - low) / static_cast<double>(grid.getResolution()));
    return static_cast<int>(std::clamp(cell, -1.0, static_cast<double>(count)));
  };
  const double x_min = static_cast<double>(grid.getXMin()), y_min = static_cast<double>(grid.getYMin());
  const int x0 = index(box.min().x() - margin, x_min, grid.getSizeX()),
            x1 = index(box.max().x() + margin, x_min, grid.getSizeX());
  const int y0 = index(box.min().y() - margin, y_min, grid.getSizeY()),
            y1 = index(box.max().y() + margin, y_min, grid.getSizeY());
  for (int y = std::max(0, y0); y <= std::min(y1, static_cast<int>(grid.getSizeY()) - 1); ++y)
    for (int x = std::max(0, x0); x <= std::min(x1, static_cast<int>(grid.getSizeX()) - 1); ++x)
      if (distanceTo(polygon, cellCentre(grid, x, y)) <= margin) visit(x, y);
}

/// The map's grid; without one an unknown grid around objects and path. Throws RunError for an empty map.
mrpt::maps::COccupancyGridMap2D gridOf(const CSemanticMap& map);

}  // namespace roomgraph
