// SPDX-License-Identifier: BSD-3-Clause
// Cuboids from vanishing points and the corners of a box (CubeSLAM).
#pragma once

#include <vector>

#include "roomgraph/proposals/placed_shape.h"

namespace roomgraph {

/// Cuboids from vanishing points (CubeSLAM's construction, method.md sec. 1.B): yaw and the position of a
/// first corner on the box's top side are sampled; vanishing lines and the box's sides give the nearest vertical edge
/// and the two bottom edges from it, which are projected onto the ground plane. A size whose face is not seen or is
/// cut is the usual one; cuboids with other unusual sizes are dropped. The front faces the camera. Empty when the
/// box's bottom is cut.
std::vector<PlacedShape> cuboidsFromCorners(const BoxEvidence& evidence);

}  // namespace roomgraph
