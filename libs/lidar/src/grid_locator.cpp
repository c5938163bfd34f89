// SPDX-License-Identifier: BSD-3-Clause
// Global correlative search in a map, coarse, and refinement on the fine grid.
#include "roomgraph/lidar/grid_locator.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "correlative_search.h"
#include "grid_refinement.h"

namespace roomgraph {
namespace {

constexpr double kCoarseCell_m = 0.1, kMinScore = 0.33, kKnownShift = 0.15;
constexpr int kMostPoints = 400;
constexpr double kOtherPlace_m = 0.5, kOtherTurn_rad = 0.2;
// Weights of the start in the refinement: a nudge along walls that fix nothing.
constexpr double kStartWeight = 0.01;

// Each cell the most occupied of factor x factor cells of the map.
ProbabilityGrid fromMap(const mrpt::maps::COccupancyGridMap2D& grid, int factor) {
  const int width = static_cast<int>(grid.getSizeX()), height = static_cast<int>(grid.getSizeY());
  const int columns = (width + factor - 1) / factor, rows = (height + factor - 1) / factor;
  std::vector<float> cells(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0.f);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float occupied = 1 - grid.getCell(x, y);
      if (std::abs(static_cast<double>(occupied) - 0.5) < kKnownShift) continue;
      float& cell = cells[static_cast<std::size_t>(y / factor) * static_cast<std::size_t>(columns) +
                          static_cast<std::size_t>(x / factor)];
      cell = std::max(cell, std::clamp(occupied, ProbabilityGrid::kMin, ProbabilityGrid::kMax));
    }
  return {factor * static_cast<double>(grid.getResolution()),
          Eigen::Vector2d(static_cast<double>(grid.getXMin()), static_cast<double>(grid.getYMin())), columns,
          rows, std::move(cells)};
}

}  // namespace

struct GridLocator::Grids {
  ProbabilityGrid fine, coarse;
  ScorePyramid pyramid;
};

GridLocator::GridLocator(const mrpt::maps::COccupancyGridMap2D& grid) {
  const int factor =
      std::max(1, static_cast<int>(std::lround(kCoarseCell_m / static_cast<double>(grid.getResolution()))));
  ProbabilityGrid coarse = fromMap(grid, factor);
  int levels = 1;
  while ((1 << levels) < 2 * std::max(coarse.width(), coarse.height())) ++levels;
  ScorePyramid pyramid(coarse, levels);
  grids_ = std::make_unique<Grids>(Grids{fromMap(grid, 1), std::move(coarse), std::move(pyramid)});
}

GridLocator::~GridLocator() = default;

std::vector<Pose2> GridLocator::search(const std::vector<Eigen::Vector2d>& points) const {
  std::vector<Pose2> out;
  for (const GridPlace& place : places(points)) out.push_back(place.grid_from_points);
  return out;
}

std::vector<GridPlace> GridLocator::places(const std::vector<Eigen::Vector2d>& points) const {
  if (points.empty()) return {};
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const auto& p : points) middle += p / static_cast<double>(points.size());
  Points2 centred;
  for (const auto& p : points) centred.push_back(p - middle);
  centred = thinnedTo(centred, kCoarseCell_m, kMostPoints);
  const ProbabilityGrid& coarse = grids_->coarse;
  const Eigen::Vector2d size(coarse.width() * coarse.cellSize(), coarse.height() * coarse.cellSize());
  const Eigen::Vector2d centre = coarse.corner() + size / 2;
  const SearchWindow window{size.maxCoeff() / 2, std::numbers::pi, 0, 0, kMinScore};
  const Pose2 start{centre.x(), centre.y(), 0};
  const Pose2 centred_from_points{-middle.x(), -middle.y(), 0};
  std::vector<GridPlace> out;
  const auto best = correlativeSearch(grids_->pyramid, centred, start, window);
  if (!best) return out;
  out.push_back({best->grid_from_scan * centred_from_points, best->score});
  const ExcludedPose around{best->grid_from_scan, kOtherPlace_m, kOtherTurn_rad};
  if (const auto other = correlativeSearch(grids_->pyramid, centred, start, window, around))
    out.push_back({other->grid_from_scan * centred_from_points, other->score});
  return out;
}

GridFit GridLocator::refine(const std::vector<Eigen::Vector2d>& points, const Pose2& start) const {
  const auto fit = refineOnGrid(grids_->fine, points, start, {start, kStartWeight, kStartWeight}, 40);
  // Neighbouring points lie on the same surface: their errors are alike.
  return {fit.grid_from_scan,
          poseCovariance(fit, {.inflation = 3, .floor_sigma_m = 0.01, .floor_sigma_rad = 0.002}),
          fit.explained, fit.contradicted};
}

}  // namespace roomgraph
