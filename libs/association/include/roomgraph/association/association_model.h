// SPDX-License-Identifier: BSD-3-Clause
// Parameters of the association posterior (paper Eq. 10): likelihood, track prior and feature shares.
#pragma once

#include "roomgraph/association/measurement_model.h"

namespace roomgraph {

/// All factors of paper Eq. 10 with their weights.
struct AssociationModel {
  MeasurementModel measurement;
  double forgetting = 0.2;
  double tempering = 1;
  double neutral_features = 5;
  double door_gain = 1, door_cue_s = 10;

  void declare(ParameterVisitor& visitor);
};

}  // namespace roomgraph
