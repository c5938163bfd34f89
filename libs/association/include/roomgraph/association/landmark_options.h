// SPDX-License-Identifier: BSD-3-Clause
// Options of the landmark map: birth, existence, duplicates, confirmation.
#pragma once

#include "roomgraph/association/landmark_rules.h"
#include "roomgraph/core/parameters.h"

namespace roomgraph {

/// [landmarks]
struct LandmarkOptions : Configurable {
  bool enabled = true, doubt_by_scan = true, hindsight = true;
  LandmarkRules rules;
  double detection_probability = 0.6, false_alarm_probability = 0.15;
  double score_gain = 5, neutral_score = 0.2, ray_gain = 0.1;
  double confirm_existence = 0.9, exclusive_overlap = 0.15;
  int confirm_observations = 6;
  void declareParameters(ParameterVisitor& v) override;
};

}  // namespace roomgraph
