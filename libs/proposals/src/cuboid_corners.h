// SPDX-License-Identifier: BSD-3-Clause
// Cuboids from vanishing points and the corners of a box (CubeSLAM).
#pragma once

#include <vector>

#include "roomgraph/proposals/placed_shape.h"

namespace roomgraph {

/// Cuboids from vanishing points (CubeSLAM's construction, method.md sec. 1.B): for sampled yaw the first
/// corner walks along the box's top side; vanishing lines and the box's sides give the nearest vertical edge
/// and both bottom edges from it, which the ground plane brings into space. Where a side is cut or the face
/// is not seen the usual size is taken; other sizes must be usual. The front looks at the camera. Empty when
/// the box's bottom is cut.
std::vector<PlacedShape> cuboidsFromCorners(const BoxEvidence& evidence);

}  // namespace roomgraph
