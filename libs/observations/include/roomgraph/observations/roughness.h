// SPDX-License-Identifier: BSD-3-Clause
// How rough a line of ranges is, and from where on that is noise.
#pragma once

#include <vector>

namespace roomgraph {

/// Roughness of a line of ranges (m; 0: no return): the median, or another quantile, of |a - 2 b + c| over neighbours a, b,
/// c. Walls and furniture are straight lines or smooth curves for most of them, noise is not. 0 when there are fewer than
/// `least`.
double roughnessOf(const std::vector<float>& ranges_m, double share = 0.5, std::size_t least = 20);
/// Of a lidar's scan: the median that normal noise has by a quantile that edges leave alone, which are most of what a narrow
/// or sparse lidar sees among furniture.
double roughnessOfScan(const std::vector<float>& ranges_m);

/// What is rougher, m, stands out where `usual_m` is usual: several times that, and more than sensors differ from wall to wall.
double roughnessLimit(double usual_m);

}  // namespace roomgraph
