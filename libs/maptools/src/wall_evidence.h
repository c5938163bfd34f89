// SPDX-License-Identifier: BSD-3-Clause
// How well the walls of two maps agree under a transform.
#pragma once

#include "region.h"

namespace roomgraph {

/// Centres of occupied cells, one for each square of `step_m`.
std::vector<Eigen::Vector2d> wallPoints(const mrpt::maps::COccupancyGridMap2D& grid, double step_m);

/// Distance between the samples that are counted, m.
inline constexpr double kWallStep_m = 0.1;

/// Of walls of one map where the other one saw something.
struct WallAgreement {
  double explained_m = 0, contradicted_m = 0;  ///< on a wall of the other map; in its free space
  double evidence = 0;                         ///< log likelihood ratio against a random place
  double share() const {
    const double all = explained_m + contradicted_m;
    return all > 0 ? explained_m / all : 0;
  }
};

/// A grid against which walls of others are held; cells near walls are found once.
class WallGrid {
 public:
  explicit WallGrid(const mrpt::maps::COccupancyGridMap2D& grid);
  const std::vector<Eigen::Vector2d>& points() const { return points_; }
  /// Samples that lie in the grid after `grid_from_points`.
  WallAgreement agreement(const std::vector<Eigen::Vector2d>& points, const Pose2& grid_from_points) const;
  double knownArea() const { return known_m2_; }
  /// Share of what this grid knows that the other one knows, too.
  double sharedWith(const WallGrid& other, const Pose2& other_from_this) const;

 private:
  enum class Kind : std::uint8_t { kUnknown, kFree, kNearWall };
  Kind kindAt(const Eigen::Vector2d& point) const;

  double cell_m_, x_min_, y_min_, known_m2_ = 0, near_share_ = 0;
  int width_, height_;
  std::vector<Kind> kinds_;
  std::vector<Eigen::Vector2d> points_;
};

}  // namespace roomgraph
