// SPDX-License-Identifier: BSD-3-Clause
// Length of a path that may have been driven in several sessions.
#pragma once

#include <vector>

#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// A step between two poses of a map that is as long as this was not driven: between them the robot was carried, or lost, or another
/// session begins.
inline constexpr double kSessionGap_m = 1;

/// What was driven, m: steps below kSessionGap_m.
double pathLength(const std::vector<StampedPose>& path);

}  // namespace roomgraph
