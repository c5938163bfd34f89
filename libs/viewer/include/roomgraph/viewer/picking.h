// SPDX-License-Identifier: BSD-3-Clause
// Which landmark somebody points at.
#pragma once

#include <optional>

#include "roomgraph/rendering/orbit_camera.h"
#include "roomgraph/viewer/view_state.h"

namespace roomgraph {

/// Distance along the ray to where it enters an object that stands there, m; 0 when it begins inside, nothing
/// when it misses. Objects thinner than 10 cm count as that thick: nobody hits a door from above.
std::optional<double> distanceToObject(const OrbitCamera::Ray& ray, const ObjectShape& shape,
                                       const Pose3& world_from_object);

/// The nearest landmark that the ray meets; candidates only where there is none of the map. Invalid: none.
LandmarkId pickLandmark(const OrbitCamera::Ray& ray, const ShownLandmarks& landmarks, bool with_candidates);

}  // namespace roomgraph
