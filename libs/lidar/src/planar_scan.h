// SPDX-License-Identifier: BSD-3-Clause
// Scan returns as points in the robot's ground plane, and their thinning.
#pragma once

#include <Eigen/StdVector>
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

Points2 transformed(const Pose2& a_from_b, const Points2& points_in_b);

}  // namespace roomgraph
