// SPDX-License-Identifier: BSD-3-Clause
// The curvature's axes, and scores along the weaker one.
#include "corridor.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

namespace roomgraph {
namespace {

constexpr double kLeastRatio = 0.3;  // rooms have .13 and more, plain walls .02, with noise of 3 cm up to .25
constexpr double kNearest_m = 0.6, kFarthestAlong_m = 1.5;
constexpr double kLargestSigma_m = 0.15;

Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axesOf(const GridRefinement& fit) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(placeCurvature(fit.curvature));
}

// The best of the shift and its neighbours: across, the walls hold the place to a cell.
int bestSumAround(const ScorePyramid& pyramid, const std::vector<ScorePyramid::Cell>& cells, const Eigen::Vector2d& shift) {
  const auto x = static_cast<int>(std::lround(shift.x())), y = static_cast<int>(std::lround(shift.y()));
  int best = 0;
  for (int dx = -1; dx <= 1; ++dx)
    for (int dy = -1; dy <= 1; ++dy) best = std::max(best, pyramid.sum(0, cells, {x + dx, y + dy}));
  return best;
}

}  // namespace

bool isCorridor(const GridRefinement& on_grid) {
  const Eigen::Vector2d held = axesOf(on_grid).eigenvalues();
  return held[0] < kLeastRatio * held[1];
}

bool fitsAlong(const ScorePyramid& pyramid, const Points2& points, const GridRefinement& on_grid, double score) {
  std::vector<ScorePyramid::Cell> cells;
  for (const Eigen::Vector2d& point : transformed(on_grid.grid_from_scan, points)) {
    const Eigen::Vector2d at = (point - pyramid.corner()) / pyramid.cellSize();
    cells.push_back({static_cast<int>(std::floor(at.x())), static_cast<int>(std::floor(at.y()))});
  }
  const Eigen::Vector2d along = axesOf(on_grid).eigenvectors().col(0);
  const double least = 255 * score * static_cast<double>(points.size());
  for (double cell = std::ceil(kNearest_m / pyramid.cellSize()); cell * pyramid.cellSize() <= kFarthestAlong_m; ++cell)
    for (const double shift : {cell, -cell})
      if (bestSumAround(pyramid, cells, shift * along) >= least) return true;
  return false;
}

bool slides(const GridRefinement& fine) {
  return fine.on_surfaces && axesOf(fine).eigenvalues()[0] < 1 / (kLargestSigma_m * kLargestSigma_m);
}

}  // namespace roomgraph
