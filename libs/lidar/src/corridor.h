// SPDX-License-Identifier: BSD-3-Clause
// Scans between walls that face one way: whether their place along them is known.
#pragma once

#include "grid_refinement.h"
#include "score_pyramid.h"

namespace roomgraph {

/// Whether nearly all surfaces face one way or its opposite: that something else tells the place is to be seen from how much worse others fit.
bool isCorridor(const GridRefinement& on_grid);

/// Whether a scan that fits in a corridor has at least this score .6 to 1.5 m farther along it or back, too.
bool fitsAlong(const ScorePyramid& pyramid, const Points2& points, const GridRefinement& on_grid, double score);

/// Whether nothing holds a match that was refined on surfaces: between two plain walls the place along them is anywhere.
bool slides(const GridRefinement& fine);

}  // namespace roomgraph
