// SPDX-License-Identifier: BSD-3-Clause
// Most probable joint assignment of one frame, with posteriors of all measurements.
#pragma once

#include <vector>

#include "roomgraph/association/associator.h"
#include "roomgraph/association/measurement_model.h"

namespace roomgraph {

/// Weights of the alternatives of one measurement, not normalised.
struct WeightedAlternatives {
  WeightedLandmarks exclusive;  ///< landmarks that take at most one measurement of a frame
  WeightedLandmarks others;     ///< the rest, "new" (invalid id) among it; sum > 0
};

/// Most probable joint assignment of a frame, with the exact marginal of each decision and the whole
/// posterior.
std::vector<Association> decideFrame(const std::vector<WeightedAlternatives>& measurements);

}  // namespace roomgraph
