// SPDX-License-Identifier: BSD-3-Clause
// Proposal selection by a CRF over a sliding window of frames.
#pragma once

#include <memory>

#include "energy_options.h"
#include "roomgraph/selection/proposal_selector.h"

namespace roomgraph {

struct ObjectWindow;  // private: the objects of the last frames

/// The full selection of method.md sec. 3 over a sliding window, output for the newest frame only.
///
/// The code of the window is that of its objects at their predicted places in the image; objects predicted
/// outside the image are left out. beta* is the similarity of the frame's code to it, and the index map to it
/// continues the objects' tracks (identityLinks), also over frames without a detection. Links to the previous
/// frame have the weight s (1 - beta), links over missed frames s (1 - beta*).
///
/// Per detection the exact minimiser of its object's chain is reported, among the proposals whose unary
/// energy alone is at most `max_energy`; its confidence is its marginal among all states. "At least once
/// within the window" (Eq. 7) applies to objects that have been tracked for a whole window. With s = 0 the
/// choices are those of UnarySelector.
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
  int window_frames_ = 5;
  double min_link_overlap_ = 0.2;
  std::unique_ptr<ObjectWindow> window_;
};

}  // namespace roomgraph
