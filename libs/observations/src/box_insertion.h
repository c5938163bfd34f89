// SPDX-License-Identifier: BSD-3-Clause
// Landmarks from the boxes of an image of known pose.
#pragma once

#include <optional>

#include "roomgraph/geometry/box.h"
#include "roomgraph/observations/CSemanticMap.h"
#include "roomgraph/observations/object_database.h"

namespace roomgraph {

/// The object of a class that stands on the floor where the box ends (method.md Eq. 2), in its usual size,
/// without an id and a yaw; the covariance is that of sec. 1.E without depth. Nothing: a side or the bottom
/// is cut by the image border, the class does not rest on the floor, or the ray does not meet it within
/// `far_m`.
std::optional<Landmark> placedByBox(const Box2& box, const ObjectModel& model, const PinholeCamera& camera,
                                    const Pose3& world_from_camera, const MapLikelihoodOptions& noise);

/// Takes a sighting into the nearest landmark of its class within the gate (Kalman filter of the place,
/// method.md sec. 4.2 for existence and class), or makes a new one when its score is high enough. Its id, or
/// nothing.
std::optional<LandmarkId> insertSighting(const Landmark& sighting, double score,
                                         const MapInsertionOptions& options,
                                         std::vector<Landmark>& landmarks);

}  // namespace roomgraph
