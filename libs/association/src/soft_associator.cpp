// SPDX-License-Identifier: BSD-3-Clause
// Per-frame posterior from measurement model, track prior and feature ownership.
#include "soft_associator.h"

#include "alternative_weights.h"

namespace roomgraph {

IMPLEMENTS_MRPT_OBJECT(SoftAssociator, Associator, roomgraph)

std::vector<Association> SoftAssociator::associate(const std::vector<WorldMeasurement>& measurements,
                                                   const std::vector<Landmark>& landmarks) {
  std::vector<WeightedAlternatives> frame;
  for (const auto& seen : measurements) {
    Alternatives alternatives = model_.measurement.alternatives(seen, landmarks);
    alternatives.fresh *= newSpaceGain(seen.measurement.t);
    const auto ids = idsOf(alternatives);
    frame.push_back(weigh(alternatives, model_, tracks_.prior(seen.measurement, ids, model_.forgetting),
                          features_.shares(seen.measurement.features, ids, model_.neutral_features)));
  }
  std::vector<Association> out = decideFrame(frame);
  for (const auto& association : out)
    tracks_.remember(measurements[association.measurement].measurement, association.posterior);
  return out;
}

double SoftAssociator::newSpaceGain(double t) const {
  return new_door_t_ && t <= *new_door_t_ + model_.door_cue_s ? model_.door_gain : 1;
}

void SoftAssociator::assigned(const WorldMeasurement& measurement, LandmarkId landmark) {
  if (measurement.measurement.proposal.shape.kind == ShapeKind::kPlanar && doors_.insert(landmark).second)
    new_door_t_ = measurement.measurement.t;
  tracks_.named(measurement.measurement, landmark);
  features_.own(measurement.measurement.features, landmark);
}

void SoftAssociator::identitiesChanged(const LandmarkIdentity& identity) {
  tracks_.resolve(identity);
  features_.resolve(identity);
}

}  // namespace roomgraph
