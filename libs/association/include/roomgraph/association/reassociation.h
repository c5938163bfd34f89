// SPDX-License-Identifier: BSD-3-Clause
// Batch re-association of a whole run: forward-backward E-step alternating with landmark estimation.
#pragma once

#include <vector>

#include "roomgraph/association/association_model.h"
#include "roomgraph/association/associator.h"
#include "roomgraph/association/landmark_rules.h"

namespace roomgraph {

/// A decision with hindsight.
struct BatchDecision {
  Association association;  ///< landmark invalid: the landmark's first sighting, as when it was made
  LandmarkId landmark;      ///< always valid
};

struct Reassociation {
  std::vector<std::vector<BatchDecision>> decisions;  ///< by frame and measurement, as they came in
  std::vector<Landmark> landmarks;  ///< those with sightings, by id; place, yaw and size anew
  LandmarkIdentity identity;        ///< the one given, with the merges and splits made here
  int rounds = 0;
  bool settled = false;  ///< the last round changed no decision
};

/// The E-step over a whole run (method.md sec. 4): every measurement is decided again against the landmarks,
/// with the past and the future of its track; landmarks are placed again by a robust mean of their
/// sightings, duplicates become one, landmarks that nobody claims go, unclaimed measurements make new ones;
/// at most `max_rounds` times, until no decision changes. `by_frame`: in order of time, with poses as they
/// are known now. `identity`: of the landmarks in `initial`. Deterministic; touches no state.
Reassociation reassociate(const std::vector<std::vector<WorldMeasurement>>& by_frame,
                          std::vector<Landmark> initial, LandmarkIdentity identity,
                          const AssociationModel& model, const LandmarkRules& rules, int max_rounds = 10);

/// Robust mean of a landmark's sightings: place (Student t, information weighted), yaw (axis first, then
/// front against back by vote), size; each sighting counts with its weight. Keeps the landmark's class and
/// model.
void estimateLandmark(Landmark& landmark, const std::vector<const WorldMeasurement*>& sightings,
                      const std::vector<double>& weights, const MeasurementModel& model);

}  // namespace roomgraph
