// SPDX-License-Identifier: BSD-3-Clause
// Least unary energy per detection, with Boltzmann confidence.
#include "unary_selector.h"

#include <cmath>

#include "potentials.h"

namespace roomgraph {

IMPLEMENTS_MRPT_OBJECT(UnarySelector, ProposalSelector, roomgraph)

void UnarySelector::declareParameters(ParameterVisitor& v) {
  options_.declare(v);
}

std::vector<ObjectMeasurement> UnarySelector::select(const FrameProposals& frame,
                                                     const FrameContext& context) {
  std::vector<ObjectMeasurement> selected;
  for (std::size_t j = 0; j < frame.detections.size(); ++j) {
    const auto& detection = frame.detections[j];
    const Proposal* best = nullptr;
    double best_energy = options_.max_energy, partition = 1;  // 1 = exp(0), the state "none"
    for (const auto& proposal : frame.proposals) {
      if (proposal.detection != static_cast<int>(j)) continue;
      const double energy = unaryEnergy(proposal, detection);
      partition += std::exp(-energy / options_.temperature);
      if (energy > best_energy) continue;
      best_energy = energy;
      best = &proposal;
    }
    if (!best) continue;
    ObjectMeasurement measurement{frame.frame, frame.t, detection, *best};
    measurement.confidence = std::exp(-best_energy / options_.temperature) / partition;
    measurement.energy.unary = best_energy;
    measurement.features =
        featuresOnObject(context.features, detection.box, *best, context.camera, kFeatureMargin_m);
    selected.push_back(std::move(measurement));
  }
  return selected;
}

}  // namespace roomgraph
