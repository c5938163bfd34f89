// SPDX-License-Identifier: BSD-3-Clause
// Greedy one-to-one assignment by posterior probability.
#pragma once

#include <vector>

#include "roomgraph/association/associator.h"

namespace roomgraph {

/// Assigns measurements in the order of their most probable alternative; each landmark at most once.
/// `posteriors[k]` sums to 1 and holds "new" (invalid id).
std::vector<Association> assignGreedily(
    const std::vector<std::vector<std::pair<LandmarkId, double>>>& posteriors);

}  // namespace roomgraph
