// SPDX-License-Identifier: BSD-3-Clause
// Batch re-association of a whole run: forward-backward E-step alternating with landmark estimation.
#pragma once

#include <functional>
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
  std::vector<std::vector<BatchDecision>> decisions;  ///< by frame and measurement, in the order of the input
  std::vector<Landmark> landmarks;  ///< those with sightings, by id; position, yaw and size estimated again
  LandmarkIdentity identity;        ///< the one given, with the merges and splits made here
  int rounds = 0;
  bool settled = false;  ///< the last round changed no decision
};

/// Associations of all frames' measurements with these landmarks. `last`: the decisions of the round before,
/// empty in the first one.
using DecideRun = std::function<std::vector<std::vector<Association>>(
    const std::vector<Landmark>& landmarks, const std::vector<std::vector<BatchDecision>>& last)>;

/// The E-step over a whole run (method.md sec. 4): every measurement is assigned to the landmarks again, with
/// the past and the future of its track; landmarks become the robust mean of their sightings, duplicates are
/// merged, landmarks without sightings are dropped, measurements without landmark initialise new ones;
/// repeated until no decision changes, at most `max_rounds` times. `by_frame`: in order of time, with the
/// current poses. `identity`: of the landmarks in `initial`. Deterministic, without side effects.
Reassociation reassociate(const std::vector<std::vector<WorldMeasurement>>& by_frame,
                          std::vector<Landmark> initial, LandmarkIdentity identity,
                          const AssociationModel& model, const LandmarkRules& rules, int max_rounds = 10);

/// The same by another rule of who is who. `model`: by which sightings that no landmark takes initialise new
/// ones, and landmarks are estimated from their sightings.
Reassociation reassociate(const std::vector<std::vector<WorldMeasurement>>& by_frame,
                          std::vector<Landmark> initial, LandmarkIdentity identity, const DecideRun& decide,
                          const MeasurementModel& model, const LandmarkRules& rules, int max_rounds = 10);

/// Every frame by an associator that knows no tracks: its own rule, with the landmarks of the whole run.
DecideRun frameByFrame(Associator& associator, const std::vector<std::vector<WorldMeasurement>>& by_frame);

/// Robust mean of a landmark's sightings: place (Student t, information weighted), yaw (axis first, then
/// front against back by vote), size; each sighting counts with its weight. Keeps the landmark's class and
/// model.
void estimateLandmark(Landmark& landmark, const std::vector<const WorldMeasurement*>& sightings,
                      const std::vector<double>& weights, const MeasurementModel& model);

}  // namespace roomgraph
