// SPDX-License-Identifier: BSD-3-Clause
// When the cells of a grid came into the robot's line of sight.
#pragma once

#include <vector>

#include "roomgraph/observations/CSemanticMap.h"

namespace roomgraph {

/// For each cell of the map's grid, row by row from the smallest y, the time (s) at which it was first in
/// line of sight from a pose of the path, within `range_m`, over cells that are not occupied; known cells
/// that never were get the time of the pose nearest to them, unknown ones the path's first. Empty without
/// grid or path.
std::vector<double> sightTimes(const CSemanticMap& map, double range_m = 6);

}  // namespace roomgraph
