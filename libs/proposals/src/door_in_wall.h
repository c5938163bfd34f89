// SPDX-License-Identifier: BSD-3-Clause
// Door in the wall that is seen beside its box.
#pragma once

#include <optional>

#include "roomgraph/proposals/box_evidence.h"
#include "roomgraph/proposals/placed_shape.h"
#include "vertical_plane.h"

namespace roomgraph {

/// A door whose frame ends at the face of the wall around the box: the sides of the box are the frame's edges
/// on that face, whether the leaf is open, set back, or not there. `leaf`: plane of the points inside the
/// box, if there is one; when it is another parallel plane, as the front of a cupboard before the wall, there
/// is no door in this wall. Nothing as well when no wall is seen, or when what the box spans on it cannot be
/// a door.
std::optional<PlacedShape> doorInWall(const std::optional<VerticalPlane>& leaf, const BoxEvidence& evidence);

/// A doorway through which the next room is seen, in the wall on one side of the box; what is on the other
/// side, the leaf or furniture, need not be on it. Nothing when `leaf` is flush with what is beside it, or
/// goes on above the box.
std::optional<PlacedShape> doorSeenThrough(const std::optional<VerticalPlane>& leaf,
                                           const BoxEvidence& evidence);

/// A door whose open leaf stands across the wall: an end of the leaf (`on_leaf`, a door taken to be there) is
/// its hinge, at the wall's face beside the box. The doorway begins there, where the wall ends: on the
/// camera's side of the leaf, or behind it when the leaf itself stands in no wall. Its fit is that of the
/// leaf. Nothing when no such wall is seen.
std::optional<PlacedShape> doorwayOfLeaf(const VerticalPlane& leaf, const PlacedShape& on_leaf,
                                         const BoxEvidence& evidence);

/// Whether a wall beside the box stands across the leaf, none is flush with it, and beside it something is
/// farther than it, as beside no closed door: the leaf is open, and the door is elsewhere.
bool standsOpen(const VerticalPlane& leaf, const BoxEvidence& evidence);

/// Whether the plane stands before a parallel wall as a cupboard does, and in none: its front, not a door.
bool isFurniture(const VerticalPlane& leaf, const BoxEvidence& evidence);

/// Whether a wall is seen on at least one side of the box and the leaf is flush with it.
bool isClosed(const VerticalPlane& leaf, const BoxEvidence& evidence);

}  // namespace roomgraph
