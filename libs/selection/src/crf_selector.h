// SPDX-License-Identifier: BSD-3-Clause
// Proposal selection by a CRF over a sliding window of frames.
#pragma once

#include <memory>

#include "energy_options.h"
#include "object_window.h"
#include "roomgraph/selection/proposal_selector.h"

namespace roomgraph {

/// The full selection of method.md sec. 3 over a sliding window, output for the newest frame only.
///
/// The code of the window is that of its objects at their predicted places in the image; objects predicted
/// outside the image are left out. beta* is the similarity of the frame's code to it, and the index map to it
/// continues the objects' tracks (identityLinks), also over frames without a detection. Links to the previous
/// frame have the weight s (c + 1 - beta), links over missed frames s (c + 1 - beta*), c = `link_weight`.
///
/// Per detection the exact minimiser of its object's chain is reported, among the proposals whose unary
/// energy alone is at most `max_energy`; its confidence is its marginal among all states. "At least once
/// within the window" (Eq. 7) applies to objects that have been tracked for a whole window. With s = 0 the
/// choices are those of UnarySelector.
///
/// With `none_competes` no energy alone admits a proposal: "none" has the energy `max_energy`, so that a
/// worse one is selected only where the frames before (Eq. 6) or "at least once" (Eq. 7) ask for it.
class CrfSelector : public ProposalSelector {
  DEFINE_MRPT_OBJECT(CrfSelector, roomgraph)
 public:
  CrfSelector();
  ~CrfSelector() override;
  CrfSelector(const CrfSelector&) = delete;
  CrfSelector& operator=(const CrfSelector&) = delete;

  void declareParameters(ParameterVisitor& visitor) override;
  std::vector<ObjectMeasurement> select(const FrameProposals& frame, const FrameContext& context) override;

 private:
  EnergyOptions options_;
  WindowOptions window_options_;
  bool none_competes_ = false;
  std::unique_ptr<ObjectWindow> window_;
};

}  // namespace roomgraph
