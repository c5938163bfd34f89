// SPDX-License-Identifier: BSD-3-Clause
// Parameters and product of the factors of the association posterior, with tempering.
#include "roomgraph/association/association_model.h"

#include <cmath>

#include "alternative_weights.h"

namespace roomgraph {

void AssociationModel::declare(ParameterVisitor& v) {
  measurement.declare(v);
  v.add(
      "forgetting", forgetting,
      {.doc =
           "Share of the evidence of a track's earlier frames that is forgotten from one frame to the next.",
       .min = 1e-4,
       .max = 1});
  v.add(
      "tempering", tempering,
      {.doc = "Exponent on the likelihood of one frame, below 1 because the sightings of a track share their "
              "errors.",
       .min = 0.01,
       .max = 1});
  v.add(
      "neutral_features", neutral_features,
      {.doc =
           "Pseudo-count: feature points of unknown owner that are added to the known ones of a measurement.",
       .min = 0.1,
       .max = 1000});
  v.add("door_gain", door_gain,
        {.doc = "Factor on the prior density of new objects after a door was seen for the first time: the "
                "robot may be "
                "entering new space. 1: doors are no cue.",
         .min = 0.1,
         .max = 100});
  v.add("door_cue_s", door_cue_s,
        {.doc = "Time for which a new door is such a cue.", .unit = "s", .min = 0, .max = 1000});
}

std::vector<LandmarkId> idsOf(const Alternatives& alternatives) {
  std::vector<LandmarkId> out;
  for (const auto& [id, weight] : alternatives.same_class) out.push_back(id);
  out.emplace_back();
  return out;
}

WeightedAlternatives weigh(const Alternatives& alternatives, const AssociationModel& model,
                           const std::vector<double>& prior, const std::vector<double>& shares) {
  WeightedAlternatives out;
  const auto evidence = [&](std::size_t i, double density) {
    return prior[i] * std::pow(shares[i] * density, model.tempering);
  };
  std::size_t i = 0;
  for (const auto& [id, density] : alternatives.same_class) {
    out.exclusive.emplace_back(id, evidence(i, density));
    ++i;
  }
  for (const auto& [id, density] : alternatives.other_class)
    out.others.emplace_back(id, evidence(i, density));
  out.others.emplace_back(LandmarkId{}, evidence(i, alternatives.fresh));
  return out;
}

}  // namespace roomgraph
