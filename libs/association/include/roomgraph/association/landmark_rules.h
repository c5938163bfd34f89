// SPDX-License-Identifier: BSD-3-Clause
// Birth of landmarks, weights of sightings, and the criterion for duplicates.
#pragma once

#include <algorithm>
#include <map>
#include <utility>

#include "roomgraph/association/world_measurement.h"
#include "roomgraph/core/parameters.h"

namespace roomgraph {

/// Factor on weight and information of a sighting whose box was carried from an earlier frame: it repeats the
/// last detection.
inline constexpr double kCarriedShare = 0.3;
/// Lower bound of the variances of a landmark, m^2 or rad^2: its sightings share errors (same view, same
/// model), so that averaging cannot make it arbitrarily precise.
inline constexpr double kLeastVariance = 1e-4;

/// The landmark created from its first sighting.
Landmark initializeLandmark(const WorldMeasurement& seen, LandmarkId id, double existence);

/// Weight of a sighting in [0, 1]: its score, less when the box was carried from an earlier frame.
double sightingWeight(const ObjectMeasurement& measurement);

/// Share of the projected model that lies inside the image, in [0, 1].
double visibleFraction(const ObjectMeasurement& measurement);

/// In how many frames two landmarks were seen side by side; the smaller id first.
using SeenTogether = std::map<std::pair<LandmarkId, LandmarkId>, int>;

/// Criterion for merging two landmarks of a class, and for splitting one.
struct DuplicateRule {
  double merge_overlap = 0.2;
  double merge_distance_ratio = 0.6;
  double apart_share = 0.1;
  double split_distance_ratio = 0.7;

  void declare(ParameterVisitor& visitor);

  /// Whether at least apart_share of the sightings of the one seen less shows the other as well, in `together` frames.
  bool seenApart(const Landmark& a, const Landmark& b, int together) const;

  /// Whether their volumes overlap too much, or their centres are too close, for two objects. Landmarks seen side by
  /// side in frames (`together` of the sightings of the one seen less) must cover each other.
  bool same(const Landmark& a, const Landmark& b, int together) const;

  /// Distance of two groups of a landmark's sightings beyond which they are two objects, m.
  double splitDistance(const ObjectShape& shape) const {
    return split_distance_ratio * shape.horizontalExtent();
  }
};

/// Initialisation and merging of landmarks, in the live map and in re-association alike.
struct LandmarkRules {
  double birth_existence = 0.3;  ///< existence probability of a landmark seen once
  DuplicateRule duplicates;
};

}  // namespace roomgraph
