// SPDX-License-Identifier: BSD-3-Clause
// Agreement of image edges with a placed cuboid: outline distance and vanishing points.
#pragma once

#include <array>
#include <optional>

#include "roomgraph/proposals/placed_shape.h"

namespace roomgraph {

/// Directions in the image: where lines along a placed cuboid's front, left and up meet, K R e_i, as
/// homogeneous pixels (method.md sec. 1.B; third component 0: at infinity).
std::array<Eigen::Vector3d, 3> vanishingPoints(const PlacedShape& placed, const BoxEvidence& evidence);

/// How well image edges speak for a cuboid or planar shape, in [0, 1]: half from the distance of its visible
/// outline's points to the nearest edge, half from how well long segments point at one of its vanishing
/// points (CubeSLAM's score). Sides that are cut or hidden are not looked at. Nothing without an image.
std::optional<double> edgeAgreement(const PlacedShape& placed, const BoxEvidence& evidence);

}  // namespace roomgraph
