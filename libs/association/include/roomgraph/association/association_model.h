// SPDX-License-Identifier: BSD-3-Clause
// Weights of association alternatives (paper Eq. 10): likelihood, track prior and feature shares combined.
#pragma once

#include "roomgraph/association/frame_decision.h"
#include "roomgraph/association/measurement_model.h"

namespace roomgraph {

/// All factors of paper Eq. 10 and how much each counts.
struct AssociationModel {
  MeasurementModel measurement;
  double forgetting = 0.2;
  double tempering = 1;
  double neutral_features = 5;

  void declare(ParameterVisitor& visitor);
};

/// Weighs alternatives by what is known beside the place. `prior` and `shares` have one value per landmark of
/// the same class, in order, and a last one for "new".
WeightedAlternatives weigh(const Alternatives& alternatives, const AssociationModel& model,
                           const std::vector<double>& prior, const std::vector<double>& shares);

/// Ids of the alternatives of the same class, then the invalid one of "new".
std::vector<LandmarkId> idsOf(const Alternatives& alternatives);

}  // namespace roomgraph
