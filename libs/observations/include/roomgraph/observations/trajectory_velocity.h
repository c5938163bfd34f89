// SPDX-License-Identifier: BSD-3-Clause
// Which poses tell the velocity at the ends of a trajectory.
#pragma once

#include <cstddef>
#include <optional>

#include "roomgraph/observations/trajectory.h"

namespace roomgraph {

/// Index of the pose from which on Trajectory::at() extrapolates beyond the last pose (or else the first one): the next one that is at
/// least 15 ms away, in its segment. Nothing: there is none, and the trajectory stands still there.
std::optional<std::size_t> velocityBase(const Trajectory& trajectory, bool at_end);

}  // namespace roomgraph
