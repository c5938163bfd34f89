// SPDX-License-Identifier: BSD-3-Clause
// Cutting of grid, landmarks and trajectory by a polygon.
#include "roomgraph/maptools/map_crop.h"

#include <cstdio>

#include "region.h"
#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

using mrpt::maps::COccupancyGridMap2D;

constexpr double kLeastArea_m2 = 1e-4;

// Cells first to last (exclusive) whose centres may lie between two coordinates.
std::pair<int, int> cellsBetween(double low, double high, double border, double cell, unsigned count) {
  const double first = std::ceil((low - border) / cell - 0.5),
               last = std::floor((high - border) / cell - 0.5);
  const double end = static_cast<double>(count);
  return {static_cast<int>(std::clamp(first, 0.0, end)), static_cast<int>(std::clamp(last + 1, 0.0, end))};
}

COccupancyGridMap2D::Ptr cutGrid(const COccupancyGridMap2D& grid, const Polygon2& polygon) {
  const auto box = boundsOf(polygon);
  const double cell = static_cast<double>(grid.getResolution());
  const double x_min = static_cast<double>(grid.getXMin()), y_min = static_cast<double>(grid.getYMin());
  const auto [x0, x1] = cellsBetween(box.min().x(), box.max().x(), x_min, cell, grid.getSizeX());
  const auto [y0, y1] = cellsBetween(box.min().y(), box.max().y(), y_min, cell, grid.getSizeY());
  if (x1 <= x0 || y1 <= y0) return nullptr;
  auto out = COccupancyGridMap2D::Create();
  out->setSize(static_cast<float>(x_min + x0 * cell), static_cast<float>(x_min + x1 * cell),
               static_cast<float>(y_min + y0 * cell), static_cast<float>(y_min + y1 * cell),
               grid.getResolution());
  out->fill(0.5f);
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x)
      if (contains(polygon, cellCentre(grid, x, y))) out->getRow(y - y0)[x - x0] = grid.getRow(y)[x];
  return out;
}

double areaOf(const Polygon2& polygon) {
  double twice = 0;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++)
    twice += polygon[j].x() * polygon[i].y() - polygon[i].x() * polygon[j].y();
  return std::abs(twice) / 2;
}

}  // namespace

CSemanticMap cropped(const CSemanticMap& map, const Polygon2& polygon) {
  if (polygon.size() < 3 || !(areaOf(polygon) > kLeastArea_m2))
    throw ConfigError("the polygon has no area: give at least three corners in order");
  CSemanticMap out = map;
  out.landmarks.clear();
  out.world_from_robot.clear();
  out.seen.clear();
  out.weights.clear();
  if (map.occupancy) out.occupancy = cutGrid(*map.occupancy, polygon);
  for (const auto& landmark : map.landmarks) {
    if (!contains(polygon, landmark.position.head<2>())) continue;
    out.landmarks.push_back(landmark);
    if (const auto seen = map.seen.find(landmark.id); seen != map.seen.end()) out.seen.insert(*seen);
    if (const auto weight = map.weights.find(landmark.id); weight != map.weights.end())
      out.weights.insert(*weight);
  }
  for (const auto& stamped : map.world_from_robot)
    if (contains(polygon, stamped.pose.translation().head<2>())) out.world_from_robot.push_back(stamped);
  std::erase_if(out.views, [&](const KeyView& view) {
    return !contains(polygon, view.world_from_camera.translation().head<2>());
  });
  const auto box = boundsOf(polygon);
  char text[128];
  std::snprintf(text, sizeof text, "cut to a polygon within x %.2f to %.2f, y %.2f to %.2f m", box.min().x(),
                box.max().x(), box.min().y(), box.max().y());
  out.provenance.history.emplace_back(text);
  return out;
}

}  // namespace roomgraph
