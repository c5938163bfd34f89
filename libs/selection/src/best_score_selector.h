// SPDX-License-Identifier: BSD-3-Clause
// Selector that takes the proposal with the best generator score: a baseline.
#pragma once

#include "roomgraph/selection/proposal_selector.h"

namespace roomgraph {

/// No selection by energy, for comparison: per detection the proposal with the generator's best score,
/// whatever it is, with confidence 1. The first of equals.
class BestScoreSelector : public ProposalSelector {
  DEFINE_MRPT_OBJECT(BestScoreSelector, roomgraph)
 public:
  std::vector<ObjectMeasurement> select(const FrameProposals& frame, const FrameContext& context) override;
};

}  // namespace roomgraph
