// SPDX-License-Identifier: BSD-3-Clause
// Counting of wall samples, and their weight as evidence.
#include "wall_evidence.h"

#include <cstdint>
#include <set>

namespace roomgraph {
namespace {

constexpr double kReach_m = 0.1;    // a wall within this distance counts as the same
constexpr double kAgreeing = 0.85;  // share of walls that agree under the true transform: things move
constexpr double kAreaStep_m = 0.2;
constexpr double kIndependent_m = 2;  // samples nearer to each other say the same
constexpr double kLeastNear = 0.02, kMostNear = 0.7;

}  // namespace

std::vector<Eigen::Vector2d> wallPoints(const mrpt::maps::COccupancyGridMap2D& grid, double step_m) {
  std::set<std::pair<int, int>> taken;
  std::vector<Eigen::Vector2d> out;
  for (int y = 0; y < static_cast<int>(grid.getSizeY()); ++y)
    for (int x = 0; x < static_cast<int>(grid.getSizeX()); ++x) {
      if (!isOccupiedCell(grid.getCell(x, y))) continue;
      const Eigen::Vector2d at = cellCentre(grid, x, y);
      if (taken
              .emplace(static_cast<int>(std::floor(at.x() / step_m)),
                       static_cast<int>(std::floor(at.y() / step_m)))
              .second)
        out.push_back(at);
    }
  return out;
}

WallGrid::WallGrid(const mrpt::maps::COccupancyGridMap2D& grid)
    : cell_m_(static_cast<double>(grid.getResolution())),
      x_min_(static_cast<double>(grid.getXMin())),
      y_min_(static_cast<double>(grid.getYMin())),
      width_(static_cast<int>(grid.getSizeX())),
      height_(static_cast<int>(grid.getSizeY())),
      kinds_(std::size_t{grid.getSizeX()} * grid.getSizeY(), Kind::kUnknown),
      points_(wallPoints(grid, kWallStep_m)) {
  const auto kind = [&](int x, int y) -> Kind& {
    return kinds_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                  static_cast<std::size_t>(x)];
  };
  const int reach = std::max(1, static_cast<int>(std::lround(kReach_m / cell_m_)));
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const float p_free = grid.getCell(x, y);
      if (isFreeCell(p_free) && kind(x, y) == Kind::kUnknown) kind(x, y) = Kind::kFree;
      if (!isOccupiedCell(p_free)) continue;
      for (int j = std::max(0, y - reach); j <= std::min(height_ - 1, y + reach); ++j)
        for (int i = std::max(0, x - reach); i <= std::min(width_ - 1, x + reach); ++i)
          kind(i, j) = Kind::kNearWall;
    }
  std::size_t near = 0, known = 0;
  for (const Kind k : kinds_) {
    near += k == Kind::kNearWall;
    known += k != Kind::kUnknown;
  }
  known_m2_ = static_cast<double>(known) * cell_m_ * cell_m_;
  near_share_ =
      known ? std::clamp(static_cast<double>(near) / static_cast<double>(known), kLeastNear, kMostNear) : 0.5;
}

WallGrid::Kind WallGrid::kindAt(const Eigen::Vector2d& point) const {
  const double x = std::floor((point.x() - x_min_) / cell_m_), y = std::floor((point.y() - y_min_) / cell_m_);
  if (!(x >= 0 && y >= 0 && x < width_ && y < height_)) return Kind::kUnknown;
  return kinds_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
}

double WallGrid::sharedWith(const WallGrid& other, const Pose2& other_from_this) const {
  const int step = std::max(1, static_cast<int>(std::lround(kAreaStep_m / cell_m_)));
  int known = 0, shared = 0;
  for (int y = 0; y < height_; y += step)
    for (int x = 0; x < width_; x += step) {
      const Eigen::Vector2d at(x_min_ + (x + 0.5) * cell_m_, y_min_ + (y + 0.5) * cell_m_);
      if (kindAt(at) == Kind::kUnknown) continue;
      ++known;
      shared += other.kindAt(other_from_this * at) != Kind::kUnknown;
    }
  return known ? static_cast<double>(shared) / known : 0;
}

WallAgreement WallGrid::agreement(const std::vector<Eigen::Vector2d>& points,
                                  const Pose2& grid_from_points) const {
  WallAgreement out;
  for (const auto& point : points) {
    const Kind kind = kindAt(grid_from_points * point);
    if (kind == Kind::kNearWall) out.explained_m += kWallStep_m;
    if (kind == Kind::kFree) out.contradicted_m += kWallStep_m;
  }
  out.evidence = (out.explained_m * std::log(kAgreeing / near_share_) +
                  out.contradicted_m * std::log((1 - kAgreeing) / (1 - near_share_))) /
                 kIndependent_m;
  return out;
}

}  // namespace roomgraph
