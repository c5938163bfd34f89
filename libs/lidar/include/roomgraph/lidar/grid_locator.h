// SPDX-License-Identifier: BSD-3-Clause
// Where a set of wall points lies in a finished occupancy grid.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <memory>
#include <vector>

#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// A pose found by refinement.
struct GridFit {
  Pose2 grid_from_points;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< of (x, y, yaw), in the grid's frame
  double explained = 0;                                      ///< share of the points on walls
  double contradicted = 0;                                   ///< share of the points in free space
};

/// A pose found by the search.
struct GridPlace {
  Pose2 grid_from_points;
  double score = 0;  ///< mean probability at the points that they lie on walls
};

/// An occupancy grid in which points are looked for. Poses are grid_from_points: m, rad.
class GridLocator {
 public:
  /// Cells hold the probability of being free (MRPT).
  explicit GridLocator(const mrpt::maps::COccupancyGridMap2D& grid);
  ~GridLocator();

  /// The best pose anywhere on the grid, at any angle, and the best clearly different one (by .5 m or .2
  /// rad): exact correlative search on cells of 0.1 m (Hess et al. 2016). Empty without points, or when less
  /// than a third of them comes to lie on walls.
  std::vector<Pose2> search(const std::vector<Eigen::Vector2d>& points) const;
  /// The same, with scores.
  std::vector<GridPlace> places(const std::vector<Eigen::Vector2d>& points) const;
  /// The nearest pose of best agreement (Gauss-Newton on the interpolated grid). There must be points.
  GridFit refine(const std::vector<Eigen::Vector2d>& points, const Pose2& start) const;

 private:
  struct Grids;
  std::unique_ptr<Grids> grids_;
};

}  // namespace roomgraph
