// SPDX-License-Identifier: BSD-3-Clause
// Plausibility of poses: finite, near enough, a proper rotation.
#pragma once

#include <string>

#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// No pose recorded indoors is farther from the world's origin, m.
inline constexpr double kFarthest_m = 1e6;

/// Why a pose is invalid ("pose is not finite", "pose is more than 1000 km away"); empty when it is not. `rounding`:
/// tolerance of the rotation matrix, per element.
std::string problemOf(const Pose3& pose, double rounding = 1e-6);
std::string problemOf(const Pose2& pose);

}  // namespace roomgraph
