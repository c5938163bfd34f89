// SPDX-License-Identifier: BSD-3-Clause
// Coarse time offset between two sensors from the turn rates that both measure.
#pragma once

#include <functional>
#include <optional>

namespace roomgraph {

/// Rate of turn at an instant of the sensor's own clock, rad/s; nothing where it was not measured.
using TurnRate = std::function<std::optional<double>(double t)>;

/// What is to be added to the stamps of `moved` so that it turns when `reference` does: the largest
/// normalised cross-correlation of turn rates at offsets of up to 0.5 s, from `from` to `to` (s, clock of the
/// reference). Nothing when there was too little turning, or when no offset makes them alike (correlation
/// below 0.5).
std::optional<double> turnRateOffset(const TurnRate& reference, const TurnRate& moved, double from,
                                     double to);

}  // namespace roomgraph
