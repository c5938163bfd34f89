// SPDX-License-Identifier: BSD-3-Clause
// One map of two sessions.
#pragma once

#include <optional>
#include <vector>

#include "roomgraph/maptools/map_difference.h"

namespace roomgraph {

/// `a` continued by `b`, which is in its frame and on its lattice (movedMap) and taken for the later one.
/// Cells: sum of the log odds. Objects: those that stayed are fused by their information, moved ones are
/// where `b` has them, vanished ones stay with what is left of their existence while it is at least .5; ids
/// are those of `a`, new objects get new ones. Poses of `b` are left out when the two sessions overlap in
/// time: a trajectory is in order of time.
///
/// `common`: a time whose records are in both, as of the pieces of one recording; s. What they say counts once: of one of
/// two estimates the share of its sightings' time that lies in it is left out, of cells that both say alike the surer one stays.
CSemanticMap unitedMaps(const CSemanticMap& a, const CSemanticMap& b, const std::vector<ObjectDifference>& difference,
                        const std::optional<SeenSpan>& common = {});

/// Whether `map` is of runs that went on with `earlier` (`run --map`), and so holds all of it.
bool continues(const CSemanticMap& map, const CSemanticMap& earlier);

}  // namespace roomgraph
