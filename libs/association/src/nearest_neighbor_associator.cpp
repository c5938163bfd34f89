// SPDX-License-Identifier: BSD-3-Clause
// Centre distances within the gate, nearest pair assigned first.
#include "nearest_neighbor_associator.h"

#include <algorithm>
#include <cmath>

#include "greedy_assignment.h"

namespace roomgraph {

IMPLEMENTS_MRPT_OBJECT(NearestNeighborAssociator, Associator, roomgraph)

void NearestNeighborAssociator::declareParameters(ParameterVisitor& v) {
  v.add("max_distance_ratio", max_distance_ratio_,
        {.doc = "Farther landmarks, in widths of the object between the centres, are not candidates.",
         .min = 0.1,
         .max = 5});
}

std::vector<Association> NearestNeighborAssociator::associate(
    const std::vector<WorldMeasurement>& measurements, const std::vector<Landmark>& landmarks) {
  // Any score that falls with the distance gives the same order; "new" comes after every landmark in gate.
  std::vector<std::vector<std::pair<LandmarkId, double>>> scores(measurements.size());
  for (std::size_t k = 0; k < measurements.size(); ++k) {
    const auto& proposal = measurements[k].measurement.proposal;
    for (const auto& landmark : landmarks) {
      if (landmark.class_name != proposal.class_name) continue;
      const double apart =
          (measurements[k].world_from_object.translation() - landmark.position).head<2>().norm();
      if (apart <= max_distance_ratio_ * std::max(proposal.shape.width, landmark.shape.width))
        scores[k].emplace_back(landmark.id, std::exp(-apart));
    }
    scores[k].emplace_back(LandmarkId{}, 0.0);
  }
  std::vector<Association> out = assignGreedily(scores);
  for (auto& association : out) {
    association.posterior = {{association.landmark, 1.0}};
    association.probability = 1;
  }
  return out;
}

}  // namespace roomgraph
