// SPDX-License-Identifier: BSD-3-Clause
// People who are drawn at random: colours of skin and hair, and how they sit on furniture.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "roomgraph/geometry/pose.h"
#include "roomgraph/simulation/world.h"

namespace roomgraph {

const std::vector<std::array<double, 3>>& skinColors();
const std::vector<std::array<double, 3>>& hairColors();

/// Height of what somebody can sit on, m: of a stool its own, of other seats that of the seat; nothing for
/// other furniture.
std::optional<double> seatHeight(const Furniture& item);
/// Where somebody sits on a seat, `along_m` beside its middle, facing its front; plan's frame.
Pose2 placeOnSeat(const Furniture& seat, double along_m);

}  // namespace roomgraph
