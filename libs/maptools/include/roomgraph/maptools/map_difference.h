// SPDX-License-Identifier: BSD-3-Clause
// What changed between two maps of one place.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roomgraph/observations/CSemanticMap.h"
#include "roomgraph/observations/object_database.h"

namespace roomgraph {

enum class ObjectChange { kStayed, kMoved, kVanished, kAppeared, kUnsure };
std::string toString(ObjectChange change);

/// One object in the earlier map, the later one, or both.
struct ObjectDifference {
  ObjectChange change = ObjectChange::kUnsure;
  std::optional<Landmark> before, after;
  double probability = 0;  ///< of the change; of an unsure one: that it vanished or appeared
  double seen = 1;         ///< share of its place that the map without it saw; 1 where both have it
};

/// What is taken for granted before looking.
struct MapDifferenceOptions {
  double moves = 0.1, vanishes = 0.15, appears = 0.15;  ///< chance for one object between two sessions
  double move_sigma_m = 2;                              ///< how far things are moved
  double found = 0.85;         ///< chance that an object whose place is seen is in the map
  double place_sigma_m = 0.1;  ///< error between sessions that covariances do not tell
};

/// Objects of two maps in one frame, those of `before` in their order, then those that only `after` has.
/// Objects of one class are paired, the likeliest first, by place, size and yaw with their covariances; a
/// pair stayed or was moved, whichever explains its distance better. What has no partner vanished (appeared)
/// with a probability of its existence, of how much of its place the other map saw, and of whether what the
/// lidar met there is still (was already) there.
std::vector<ObjectDifference> differenceOf(const CSemanticMap& before, const CSemanticMap& after,
                                           const MapDifferenceOptions& options = {});

/// {"objects": [{"change", "probability", "seen", "class", "before": {id, x, y, yaw}, "after": …}]}
std::string differenceJson(const std::vector<ObjectDifference>& difference);
/// Floor plan of the later map with the changes: gone dashed red, new green, moved blue with an arrow, the
/// rest grey.
std::string differenceSvg(const CSemanticMap& before, const CSemanticMap& after,
                          const std::vector<ObjectDifference>& difference, double scale = 50);

}  // namespace roomgraph
