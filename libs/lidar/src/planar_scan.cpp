// SPDX-License-Identifier: BSD-3-Clause
// Projection of a scan to 2D points and grid-based subsampling.
#include "planar_scan.h"

#include <cmath>
#include <cstdint>
#include <unordered_set>

namespace roomgraph {

PlanarScan toPlanarScan(const Scan& scan, double min_range_m, double max_range_m) {
  PlanarScan out;
  out.origin = scan.robot_from_lidar.translation().head<2>();
  out.points.reserve(scan.ranges_m.size());
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    const double range = scan.ranges_m[i];
    if (!scan.valid[i] || range < min_range_m || range > max_range_m) continue;
    const double angle = scan.angle_min_rad + static_cast<double>(i) * scan.angle_step_rad;
    const Eigen::Vector3d in_lidar(range * std::cos(angle), range * std::sin(angle), 0);
    out.points.emplace_back((scan.robot_from_lidar * in_lidar).head<2>());
  }
  return out;
}

Points2 thinned(const Points2& points, double cell_m) {
  Points2 out;
  std::unordered_set<std::uint64_t> taken;
  for (const Eigen::Vector2d& p : points) {
    const auto x = static_cast<std::uint32_t>(static_cast<std::int32_t>(std::floor(p.x() / cell_m)));
    const auto y = static_cast<std::uint32_t>(static_cast<std::int32_t>(std::floor(p.y() / cell_m)));
    if (taken.insert((static_cast<std::uint64_t>(x) << 32) | y).second) out.push_back(p);
  }
  return out;
}

Points2 thinnedTo(const Points2& points, double cell_m, int max_points) {
  Points2 out = thinned(points, cell_m);
  while (static_cast<int>(out.size()) > max_points) out = thinned(points, cell_m *= 1.4);
  return out;
}

Points2 transformed(const Pose2& a_from_b, const Points2& points_in_b) {
  const PointsMovement movement(a_from_b);
  Points2 out;
  out.reserve(points_in_b.size());
  for (const Eigen::Vector2d& p : points_in_b) out.push_back(movement * p);
  return out;
}

}  // namespace roomgraph
