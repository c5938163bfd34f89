// SPDX-License-Identifier: BSD-3-Clause
// Agreement of image edges with a placed cuboid: outline distance and vanishing points.
#pragma once

#include <array>
#include <optional>

#include "roomgraph/proposals/placed_shape.h"

namespace roomgraph {

/// Vanishing points of a placed cuboid's front, left and up axes, K R e_i, as homogeneous pixels (method.md sec. 1.B;
/// third component 0: at infinity).
std::array<Eigen::Vector3d, 3> vanishingPoints(const PlacedShape& placed, const BoxEvidence& evidence);

/// Agreement of image edges with a cuboid or planar shape, in [0, 1]: half from the distance of its visible edges to
/// the nearest image edge, half from how well long segments point at one of its vanishing points (CubeSLAM's score).
/// What is outside the image or beyond a hidden side of the box is left out. Nothing without an image.
std::optional<double> edgeAgreement(const PlacedShape& placed, const BoxEvidence& evidence);

}  // namespace roomgraph
