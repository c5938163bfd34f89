// SPDX-License-Identifier: BSD-3-Clause
// A part of a map.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "roomgraph/observations/CSemanticMap.h"

namespace roomgraph {

/// What of the map lies in a polygon (world, m, at least three corners in order, without crossings): cells
/// whose centre, objects whose place, and poses that are inside. The grid shrinks to the polygon's bounds on
/// the lattice of the old one, and cells outside are unknown. Throws ConfigError for a polygon without area.
CSemanticMap cropped(const CSemanticMap& map, const std::vector<Eigen::Vector2d>& polygon);

}  // namespace roomgraph
