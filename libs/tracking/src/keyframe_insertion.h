// SPDX-License-Identifier: BSD-3-Clause
// Insertion of a keyframe into the local map.
#pragma once

#include "local_map.h"

namespace roomgraph::tracking {

/// Adds a keyframe to the map: sightings of the points it tracked, new points for its other features with
/// depth, sightings of these in neighbouring keyframes; removes recent points that did not prove stable.
/// Returns its index.
int insertKeyframe(LocalMap& map, Keyframe keyframe, const TrackingParameters& parameters);

}  // namespace roomgraph::tracking
