// SPDX-License-Identifier: BSD-3-Clause
// Which landmarks the tracked feature points of a run are seen on.
#pragma once

#include <cstdint>
#include <vector>

#include "roomgraph/association/reassociation.h"

namespace roomgraph {

/// Who has the feature points of all measurements of a run: each sighting of a point votes for the landmark that it was seen on.
class FeatureVotes {
 public:
  /// Nobody has any yet. `frames`: measurements by frame.
  explicit FeatureVotes(const std::vector<std::vector<WorldMeasurement>>& frames);

  /// Who has them by these decisions, by frame and measurement; empty: nobody.
  void count(const std::vector<std::vector<BatchDecision>>& decisions);

  /// p0 of each of `ids` (invalid: new) for a measurement, by the other sightings of its points: `own`, its landmark by the
  /// decisions, has one vote less. `neutral` points are spread evenly; uniform where no other sighting votes.
  std::vector<double> shares(std::size_t frame, std::size_t measurement, LandmarkId own, const std::vector<LandmarkId>& ids,
                             double neutral) const;

 private:
  void addVotes(std::size_t point, LandmarkId own, const std::vector<LandmarkId>& ids, std::vector<double>& owned, double& total) const;

  std::vector<std::vector<std::vector<std::uint32_t>>> points_;  // numbers, by frame and measurement
  std::vector<std::size_t> begin_;                               // of each point's votes, and the end of the last one's
  std::vector<LandmarkId> votes_;                                // of each point in ascending order
  bool counted_ = false;
};

}  // namespace roomgraph
