// SPDX-License-Identifier: BSD-3-Clause
// What one sensor tells another about the movement between two of its records.
#pragma once

#include <initializer_list>
#include <optional>

#include "roomgraph/estimation/motion.h"

namespace roomgraph {

constexpr double kPredictionHorizon_s = 0.15;  // a source may be extrapolated this far

/// By the first source that covers the time. What wheels say of a pause in which the robot may have been carried is no prediction.
inline std::optional<Movement> predictedMovement(double t_a, double t_b, std::initializer_list<const MotionSource*> sources) {
  for (const auto* source : sources)
    if (const auto moved = source->between(t_a, t_b, kPredictionHorizon_s); moved && !source->pausedWithin(t_a, t_b)) return moved;
  return std::nullopt;
}

}  // namespace roomgraph
