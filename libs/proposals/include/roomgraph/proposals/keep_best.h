// SPDX-License-Identifier: BSD-3-Clause
// Choice of the best hypotheses of one object (non-maximum suppression).
#pragma once

#include <numbers>
#include <vector>

#include "roomgraph/proposals/placed_shape.h"

namespace roomgraph {

/// How many hypotheses a generator may return, and which.
struct GeneratorLimits {
  int max_count = 4;
  double min_iou = 0.3;                          ///< least IoU of the projected shape with the box
  std::vector<PlacedShape>* rejected = nullptr;  ///< dropped hypotheses go here, when set
};

/// Two hypotheses are the same when they are nearer than `distance_m` and turned by less than `angle_rad`.
struct SamePlace {
  double distance_m = 0.05, angle_rad = 0.1;
};
/// Larger than any difference of yaws: only the distance is compared.
inline constexpr double kAnyYaw_rad = 2 * std::numbers::pi;

/// Best quality first, at most as many as allowed, none that is the same as a better one.
std::vector<PlacedShape> keepBest(std::vector<PlacedShape> all, const SamePlace& same, const GeneratorLimits& limits);

}  // namespace roomgraph
