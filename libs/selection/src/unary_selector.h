// SPDX-License-Identifier: BSD-3-Clause
// Proposal selection frame by frame by unary energy: a baseline.
#pragma once

#include "energy_options.h"
#include "roomgraph/selection/proposal_selector.h"

namespace roomgraph {

/// Each frame alone: per detection the proposal with the lowest alpha * U, if it is low enough.
/// Confidence is the Boltzmann probability of the choice among {none} and the detection's proposals.
class UnarySelector : public ProposalSelector {
  DEFINE_MRPT_OBJECT(UnarySelector, roomgraph)
 public:
  void declareParameters(ParameterVisitor& visitor) override;
  std::vector<ObjectMeasurement> select(const FrameProposals& frame, const FrameContext& context) override;

 private:
  EnergyOptions options_;
};

}  // namespace roomgraph
