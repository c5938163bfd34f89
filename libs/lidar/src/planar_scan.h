// SPDX-License-Identifier: BSD-3-Clause
// Scan returns as points in the robot's ground plane, and their thinning.
#pragma once

#include <Eigen/StdVector>
#include <cmath>
#include <vector>

#include "roomgraph/observations/scan.h"

namespace roomgraph {

using Points2 = std::vector<Eigen::Vector2d>;

/// Usable returns of a scan on the ground plane, in the robot frame, m.
struct PlanarScan {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< where the lidar stands
  Points2 points;
};

/// Returns nearer than `min_range_m` (the robot itself) or beyond `max_range_m` are left out.
PlanarScan toPlanarScan(const Scan& scan, double min_range_m, double max_range_m);

/// Grid subsampling: the first point, in the order of the beams, of every square cell of `cell_m`. Near
/// surfaces, with many returns per metre, then weigh no more than far ones.
Points2 thinned(const Points2& points, double cell_m);
/// Thinned with the finest of the cells `cell_m`, 1.4 `cell_m`, 2 `cell_m` … that leaves at most
/// `max_points`.
Points2 thinnedTo(const Points2& points, double cell_m, int max_points);

/// A pose that many points are moved by: as Pose2, but sine and cosine are taken once.
class PointsMovement {
 public:
  explicit PointsMovement(const Pose2& a_from_b)
      : x_(a_from_b.x), y_(a_from_b.y), cos_(std::cos(a_from_b.yaw)), sin_(std::sin(a_from_b.yaw)) {}
  Eigen::Vector2d operator*(const Eigen::Vector2d& in_b) const {
    return {x_ + cos_ * in_b.x() - sin_ * in_b.y(), y_ + sin_ * in_b.x() + cos_ * in_b.y()};
  }

 private:
  double x_, y_, cos_, sin_;
};
Points2 transformed(const Pose2& a_from_b, const Points2& points_in_b);

}  // namespace roomgraph
