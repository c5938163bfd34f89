// SPDX-License-Identifier: BSD-3-Clause
// Voxel traversal (Amanatides and Woo 1987) with log-odds updates.
#include "ray_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace roomgraph {

using mrpt::maps::COccupancyGridMap2D;

namespace {

using LogOdds = mrpt::maps::CLogOddsGridMap2D<COccupancyGridMap2D::cellType>;

// Log odds are stored in whole steps: of a probability near a half the least one, not none.
COccupancyGridMap2D::cellType stepOf(double probability) {
  using Step = COccupancyGridMap2D::cellType;
  return std::max<Step>(1, COccupancyGridMap2D::p2l(static_cast<float>(probability)));
}

}  // namespace

RayGrid::RayGrid(COccupancyGridMap2D& grid, double hit_probability, double pass_probability)
    : grid_(grid),
      hit_(stepOf(hit_probability)),
      pass_(stepOf(1 - pass_probability)),
      stamp_(std::size_t{grid.getSizeX()} * grid.getSizeY(), 0) {}

std::size_t RayGrid::index(const Eigen::Vector2i& cell) const {
  return static_cast<std::size_t>(cell.y()) * grid_.getSizeX() + static_cast<std::size_t>(cell.x());
}

Eigen::Vector2d RayGrid::toCells(const Eigen::Vector2d& world) const {
  const Eigen::Vector2d corner(static_cast<double>(grid_.getXMin()), static_cast<double>(grid_.getYMin()));
  return (world - corner) / static_cast<double>(grid_.getResolution());
}

void RayGrid::markHit(std::size_t at) {
  if (stamp_[at] == scan_) return;
  stamp_[at] = scan_;
  Cell* cell = grid_.getRow(0) + at;
  LogOdds::updateCell_fast_occupied(cell, hit_, static_cast<Cell>(LogOdds::CELLTYPE_MIN + hit_));
}

// Amanatides & Woo, "A fast voxel traversal algorithm for ray tracing", 1987: visits every cell that the
// segment crosses, except its last one when that holds the return.
void RayGrid::walk(const Eigen::Vector2d& from, const Eigen::Vector2d& to, bool hit) {
  Eigen::Vector2i cell(static_cast<int>(std::floor(from.x())), static_cast<int>(std::floor(from.y())));
  const Eigen::Vector2i last(static_cast<int>(std::floor(to.x())), static_cast<int>(std::floor(to.y())));
  const Eigen::Vector2d direction = to - from;
  Eigen::Vector2i step;
  Eigen::Vector2d next, delta;  // in units of the segment's length
  for (int k = 0; k < 2; ++k) {
    step[k] = direction[k] >= 0 ? 1 : -1;
    const double inverse =
        direction[k] != 0 ? 1 / std::abs(direction[k]) : std::numeric_limits<double>::infinity();
    const double to_border = direction[k] >= 0 ? cell[k] + 1 - from[k] : from[k] - cell[k];
    delta[k] = inverse;
    next[k] = direction[k] != 0 ? to_border * inverse : inverse;
  }
  Cell* const cells = grid_.getRow(0);
  const auto free_limit = static_cast<Cell>(LogOdds::CELLTYPE_MAX - pass_);
  const int count = (last - cell).cwiseAbs().sum() + (hit ? 0 : 1);
  for (int i = 0; i < count; ++i) {
    const std::size_t at = index(cell);
    if (stamp_[at] != scan_) {
      stamp_[at] = scan_;
      LogOdds::updateCell_fast_free(cells + at, pass_, free_limit);
    }
    const int axis = next.x() < next.y() ? 0 : 1;
    cell[axis] += step[axis];
    next[axis] += delta[axis];
  }
}

void RayGrid::insert(const Eigen::Vector2d& origin, const std::vector<Ray>& rays) {
  ++scan_;
  for (const auto& ray : rays)
    if (ray.hit) markHit(index(toCells(ray.end).array().floor().cast<int>()));
  for (const auto& ray : rays) walk(toCells(origin), toCells(ray.end), ray.hit);
}

}  // namespace roomgraph
