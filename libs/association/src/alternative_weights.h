// SPDX-License-Identifier: BSD-3-Clause
// Weights of association alternatives (paper Eq. 10): likelihood, track prior and feature shares combined.
#pragma once

#include <vector>

#include "frame_decision.h"
#include "roomgraph/association/association_model.h"

namespace roomgraph {

/// Multiplies the place likelihoods by track prior and feature shares, which have one value per landmark of the same
/// class, in order, and a last one for "new".
WeightedAlternatives weigh(const Alternatives& alternatives, const AssociationModel& model,
                           const std::vector<double>& prior, const std::vector<double>& shares);

/// Ids of the alternatives of the same class, then the invalid one of "new".
std::vector<LandmarkId> idsOf(const Alternatives& alternatives);

}  // namespace roomgraph
