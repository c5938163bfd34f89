// SPDX-License-Identifier: BSD-3-Clause
// Position of a chair's single leg from near-vertical segments.
#pragma once

#include <optional>
#include <vector>

#include "roomgraph/geometry/box.h"
#include "roomgraph/observations/proposal.h"

namespace roomgraph {

/// Column of an object's single leg, from image segments (paper sec. IV.A).
struct LegLine {
  std::optional<double> column;  ///< px, at the box's bottom side; nothing without a clear leg
  std::vector<double> votes;     ///< px, at the bottom side, of steep segments near it
};

/// Near-vertical segments in the lower part of the box, extended to its bottom side by no more than a multiple of their
/// length. The leg is the weighted mean of the longest and those beside it (the tube's other side).
LegLine findLeg(const std::vector<Segment2>& segments, const Box2& box);

}  // namespace roomgraph
