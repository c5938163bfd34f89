// SPDX-License-Identifier: BSD-3-Clause
// Plausibility of poses: finite, near enough, a proper rotation.
#pragma once

#include <string>

#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// Farther away from the world's origin is nothing that a robot indoors records.
inline constexpr double kFarthest_m = 1e6;

/// Why these values cannot be true ("pose is not finite", "pose is more than 1000 km away"); empty when they
/// can. `rounding`: of the rotation matrix, per element.
std::string problemOf(const Pose3& pose, double rounding = 1e-6);
std::string problemOf(const Pose2& pose);

}  // namespace roomgraph
