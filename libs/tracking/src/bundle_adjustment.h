// SPDX-License-Identifier: BSD-3-Clause
// Windowed bundle adjustment around a keyframe.
#pragma once

#include "local_map.h"

namespace roomgraph::tracking {

/// Windowed bundle adjustment around keyframe `index`: it and the keyframes that share most points with it
/// move, with all points they see; further keyframes that see these points hold them. Sightings that do not
/// fit are removed.
void adjustLocally(LocalMap& map, int index, const TrackingParameters& parameters);

}  // namespace roomgraph::tracking
