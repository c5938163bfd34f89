// SPDX-License-Identifier: BSD-3-Clause
// Bounding box of a projected object model.
#pragma once

#include <optional>

#include "roomgraph/geometry/box_sides.h"
#include "roomgraph/geometry/camera.h"
#include "roomgraph/geometry/shape.h"

namespace roomgraph {

/// Image extent of a projected model, px.
struct ProjectedShape {
  Box2 full;     ///< bounds of the part in front of the camera, may reach outside the image
  Box2 visible;  ///< bounds of the part inside the image
  BoxSides cut;  ///< sides of `full` outside the image
};

/// Bounding box of the model's silhouette (paper Eq. 13: b = min/max of the projected shape). Edges are
/// clipped at `near_m`; nothing when the whole model is behind it or outside the image.
std::optional<ProjectedShape> projectShape(const ObjectShape& shape, const Pose3& camera_from_object,
                                           const PinholeCamera& camera, double near_m = 0.05);

/// Bounds of the part of the silhouette inside a window of the image (px; its sides may be infinite); nothing when no part
/// is.
std::optional<Box2> boundsWithin(const Box2& window, const ObjectShape& shape, const Pose3& camera_from_object,
                                 const PinholeCamera& camera, double near_m = 0.05);

}  // namespace roomgraph
