// SPDX-License-Identifier: BSD-3-Clause
// Track posterior carried from frame to frame, and landmarks that own tracked feature points.
#pragma once

#include <map>
#include <vector>

#include "roomgraph/association/measurement_model.h"

namespace roomgraph {

/// The product over the frames of a track (method.md sec. 4), one factor at a time: the posterior of the last sighting
/// is the prior of the next. In every frame a share of it is spread evenly, so that a wrong initial decision is
/// overcome: a larger one, the less the frame is like the one before (p_c, proportional to beta, Eq. 5).
class TrackMemory {
 public:
  /// `backwards`: sightings come from the last one to the first.
  explicit TrackMemory(bool backwards = false) : backwards_(backwards) {}

  /// Prior of each of `ids` (invalid: new), summing to at most 1; even for a track that is new. `forgetting`:
  /// share of the past that is lost from one frame to the next, in (0, 1].
  std::vector<double> prior(const ObjectMeasurement& measurement, const std::vector<LandmarkId>& ids,
                            double forgetting) const;
  void remember(const ObjectMeasurement& measurement, const WeightedLandmarks& posterior);
  /// Called with the landmark of a measurement; a new landmark takes over the probability of "new".
  void named(const ObjectMeasurement& measurement, LandmarkId landmark);
  /// Replaces the ids of merged landmarks by those they were merged into.
  void resolve(const LandmarkIdentity& identity);

 private:
  struct Past {
    double t = 0;
    double beta = 1;  // of its frame: how much it is like the one before
    std::map<LandmarkId, double> posterior;
  };
  using Key = std::pair<bool, std::int64_t>;  // flag: the detector's own ids, which are no gamma chains
  static Key keyOf(const ObjectMeasurement& measurement);

  bool backwards_;
  std::map<Key, Past> tracks_;
};

/// Which landmark the tracked feature points belong to: the last one whose sighting showed them.
class FeatureOwners {
 public:
  void own(const std::vector<std::int64_t>& features, LandmarkId landmark);
  /// Replaces the ids of merged landmarks by those they were merged into.
  void resolve(const LandmarkIdentity& identity);

  /// p0 of each of `ids`: share of the points that belong to it, with `weight` points spread evenly; uniform without
  /// points.
  std::vector<double> shares(const std::vector<std::int64_t>& features, const std::vector<LandmarkId>& ids,
                             double weight) const;

 private:
  std::map<std::int64_t, LandmarkId> owners_;
};

}  // namespace roomgraph
