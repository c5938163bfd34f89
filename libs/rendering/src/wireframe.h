// SPDX-License-Identifier: BSD-3-Clause
// Image segments of model wireframes, ground grid and horizon.
#pragma once

#include <vector>

#include "roomgraph/geometry/camera.h"
#include "roomgraph/geometry/shape.h"
#include "roomgraph/observations/proposal.h"

namespace roomgraph {

/// Image of a straight line between two points of the camera frame; nothing when it lies behind `near_m`.
std::optional<Segment2> projectSegment(Eigen::Vector3d a, Eigen::Vector3d b, const PinholeCamera& camera,
                                       double near_m = 0.05);

/// Edges of a model as the camera sees them, px; may reach outside the image. A cylinder gives its two
/// circles and four upright lines, the others the edges of their box.
std::vector<Segment2> wireframe(const ObjectShape& shape, const Pose3& camera_from_object,
                                const PinholeCamera& camera);

/// Lines on the ground every metre up to `range_m` around the point below the camera, px.
std::vector<Segment2> groundGrid(const Plane& ground, const PinholeCamera& camera, int range_m = 6);

/// Where the ground vanishes, over the width of the image; nothing when the camera looks straight down.
std::optional<Segment2> horizon(const Plane& ground, const PinholeCamera& camera);

}  // namespace roomgraph
