// SPDX-License-Identifier: BSD-3-Clause
// Selector that takes the proposal with the best generator score: a baseline.
#pragma once

#include "roomgraph/selection/proposal_selector.h"

namespace roomgraph {

/// Baseline without energies: per detection the proposal with the highest generator score (of equals the
/// first), with confidence 1.
class BestScoreSelector : public ProposalSelector {
  DEFINE_MRPT_OBJECT(BestScoreSelector, roomgraph)
 public:
  std::vector<ObjectMeasurement> select(const FrameProposals& frame, const FrameContext& context) override;
};

}  // namespace roomgraph
