// SPDX-License-Identifier: BSD-3-Clause
// Test of lidar returns against angular sectors with range limits.
#include "roomgraph/lidar/dynamic_return_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace roomgraph {
namespace {

bool contains(const DynamicWedge& wedge, const Eigen::Vector2d& point_in_robot) {
  const Eigen::Vector2d ray = point_in_robot - wedge.apex;
  const double range = ray.norm();
  if (range < wedge.range_near_m || range > wedge.range_far_m) return false;
  const double turn = 2 * std::numbers::pi;
  const auto aboveMin = [&](double angle) {
    const double difference = std::fmod(angle - wedge.angle_min_rad, turn);
    return difference < 0 ? difference + turn : difference;
  };
  return aboveMin(std::atan2(ray.y(), ray.x())) <= aboveMin(wedge.angle_max_rad);
}

}  // namespace

int removeDynamicReturns(Scan& scan, const std::vector<DynamicWedge>& wedges) {
  int removed = 0;
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    if (!scan.valid[i]) continue;
    const double angle = scan.angle_min_rad + static_cast<double>(i) * scan.angle_step_rad;
    const double range = scan.ranges_m[i];
    const Eigen::Vector3d point =
        scan.robot_from_lidar * Eigen::Vector3d(range * std::cos(angle), range * std::sin(angle), 0);
    const auto inside = [&](const DynamicWedge& wedge) { return contains(wedge, point.head<2>()); };
    if (!std::any_of(wedges.begin(), wedges.end(), inside)) continue;
    scan.valid[i] = 0;
    ++removed;
  }
  return removed;
}

Scan withoutBeams(Scan scan, const std::vector<std::size_t>& beams) {
  for (const std::size_t beam : beams) scan.valid[beam] = 0;
  return scan;
}

}  // namespace roomgraph
