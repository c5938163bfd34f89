// SPDX-License-Identifier: BSD-3-Clause
// Doors placed from image edges and the ground plane, without depth.
#pragma once

#include <optional>
#include <vector>

#include "roomgraph/proposals/placed_shape.h"

namespace roomgraph {

/// A measured number with its standard deviation.
struct Measured {
  double value = 0, sigma = 0;
};

/// Range on the ground, m, of a door's side seen in column `u`: from its foot at the box's bottom (paper Eq. 2) and,
/// with the usual height, from the box's top, weighted by their variances (box sides, height, ground tilt). Nothing
/// when bottom and top are cut or too near to the horizon.
std::optional<Measured> sideRange(const BoxEvidence& evidence, double u);

/// Direction on the ground of the horizontal line in space that an image segment shows: where the plane through camera
/// and segment meets the ground; rad, in (-pi, pi]. `pixel`: standard deviation of the segment's ends, px. Nothing for
/// steep segments and those near the horizon, whose direction is uncertain.
std::optional<Measured> levelDirection(const Segment2& segment, const BoxEvidence& evidence, double pixel);

/// Doors placed without depth points: a side of the box gives the range of the door's nearer side; the direction comes
/// from segments in the box, from the usual width and the box's other side, or is assumed (facing the camera).
std::vector<PlacedShape> doorsFromImage(const BoxEvidence& evidence);

}  // namespace roomgraph
