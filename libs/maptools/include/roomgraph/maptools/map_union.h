// SPDX-License-Identifier: BSD-3-Clause
// One map of two sessions.
#pragma once

#include <vector>

#include "roomgraph/maptools/map_difference.h"

namespace roomgraph {

/// `a` continued by `b`, which is in its frame and on its lattice (movedMap) and taken for the later one.
/// Cells: sum of the log odds. Objects: those that stayed are fused by their information, moved ones are
/// where `b` has them, vanished ones stay with what is left of their existence while it is at least .5; ids
/// are those of `a`, new objects get new ones. Poses of `b` are left out when the two sessions overlap in
/// time: a trajectory is in order of time.
CSemanticMap unitedMaps(const CSemanticMap& a, const CSemanticMap& b,
                        const std::vector<ObjectDifference>& difference);

}  // namespace roomgraph
