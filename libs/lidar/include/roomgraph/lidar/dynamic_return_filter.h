// SPDX-License-Identifier: BSD-3-Clause
// Removal of lidar returns on moving people.
#pragma once

#include <vector>

#include "roomgraph/observations/scan.h"

namespace roomgraph {

/// Ground-plane sector in the robot frame in which returns belong to something that moves (method.md sec. 5):
/// the frustum of a person's box, cut at the person's nearest and farthest depth.
struct DynamicWedge {
  double angle_min_rad = 0, angle_max_rad = 0;  ///< counter-clockwise from min to max; may cross +-pi
  double range_near_m = 0, range_far_m = 0;     ///< horizontal distance from `apex`
  Eigen::Vector2d apex =
      Eigen::Vector2d::Zero();  ///< m, robot frame; the camera's place, or the robot's origin
};

/// Marks the valid returns inside any wedge as invalid. Returns how many.
int removeDynamicReturns(Scan& scan, const std::vector<DynamicWedge>& wedges);

/// The scan with the returns of these beams marked as invalid.
Scan withoutBeams(Scan scan, const std::vector<std::size_t>& beams);

}  // namespace roomgraph
