// SPDX-License-Identifier: BSD-3-Clause
// Position of a chair's single leg from near-vertical segments.
#pragma once

#include <optional>
#include <vector>

#include "roomgraph/geometry/box.h"
#include "roomgraph/observations/proposal.h"

namespace roomgraph {

/// What the segments say about where a single leg stands (paper sec. IV.A).
struct LegLine {
  std::optional<double> column;  ///< px on the box's bottom line; nothing when the leg is ill-conditioned
  std::vector<double> votes;     ///< px on the bottom line, of all steep segments near it
};

/// Near-vertical segments in the lower part of the box, extended to its bottom line. The leg is where the
/// longest of them and those beside it (the tube's other side) agree; it must not be far to extend.
LegLine findLeg(const std::vector<Segment2>& segments, const Box2& box);

}  // namespace roomgraph
