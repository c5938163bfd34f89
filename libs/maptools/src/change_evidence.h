// SPDX-License-Identifier: BSD-3-Clause
// What the other map says about the place of an object that it does not have.
#pragma once

#include "region.h"

namespace roomgraph {

/// The place of an object in a map that has it (own) and in one that has not (other).
struct PlaceEvidence {
  double seen = 0;         ///< share of footprint and surroundings that the other map knows
  double still_there = 1;  ///< occupied area there against the own map's, at most 1
  bool met_by_lidar =
      false;  ///< the own map has something occupied there, so that the other one can be asked

  /// That the object is not in the other session's world (Bayes), given the chance of a change beforehand and
  /// the chance that an object whose place is seen gets into the map.
  double probabilityOfChange(double beforehand, double found) const;
};

PlaceEvidence placeEvidence(const Landmark& landmark, const CSemanticMap& own, const CSemanticMap& other);

}  // namespace roomgraph
