// SPDX-License-Identifier: BSD-3-Clause
// Windowed bundle adjustment around a keyframe.
#pragma once

#include "local_map.h"

namespace roomgraph {
class ResultStore;
}

namespace roomgraph::tracking {

/// Windowed bundle adjustment around keyframe `index`. Free: its pose, the poses of the keyframes most
/// covisible with it, and all points these see. Fixed: further keyframes that see these points, which
/// removes the gauge freedom. Sightings whose reprojection error exceeds the 95 % bound afterwards are
/// removed. The solution is kept in `results`, and recalled from there; may be null.
void adjustLocally(LocalMap& map, int index, const TrackingParameters& parameters,
                   ResultStore* results = nullptr);

}  // namespace roomgraph::tracking
