// SPDX-License-Identifier: BSD-3-Clause
// Best score per detection, with its features.
#include "best_score_selector.h"

#include "potentials.h"

namespace roomgraph {

IMPLEMENTS_MRPT_OBJECT(BestScoreSelector, ProposalSelector, roomgraph)

std::vector<ObjectMeasurement> BestScoreSelector::select(const FrameProposals& frame,
                                                         const FrameContext& context) {
  std::vector<ObjectMeasurement> selected;
  for (std::size_t j = 0; j < frame.detections.size(); ++j) {
    const auto& detection = frame.detections[j];
    const Proposal* best = nullptr;
    for (const auto& proposal : frame.proposals)
      if (proposal.detection == static_cast<int>(j) && (!best || proposal.score > best->score))
        best = &proposal;
    if (!best) continue;
    ObjectMeasurement measurement{frame.frame, frame.t, detection, *best};
    measurement.energy.unary = unaryEnergy(*best, detection);
    measurement.features =
        featuresOnObject(context.features, detection.box, *best, context.camera, kFeatureMargin_m);
    selected.push_back(std::move(measurement));
  }
  return selected;
}

}  // namespace roomgraph
