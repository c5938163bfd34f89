// SPDX-License-Identifier: BSD-3-Clause
// Exact correlative scan matching in a window, by branch and bound.
#pragma once

#include <optional>

#include "score_pyramid.h"

namespace roomgraph {

/// Where to look, around the initial pose, and what a shift from it costs.
struct SearchWindow {
  double linear_m = 0.2, angular_rad = 0.2;         ///< half widths; the linear one is a square's
  double penalty_per_m2 = 0, penalty_per_rad2 = 0;  ///< taken off the score: times the squared shift
  double min_score = 0;                             ///< poses that score no more are not found
};

/// Leaves out poses around one that is known already, to look for a second, different solution.
struct ExcludedPose {
  Pose2 pose;
  double radius_m = 0, radius_rad = 0;
};

struct SearchResult {
  Pose2 grid_from_scan;
  double score = 0;  ///< mean probability at the points, less the penalty
};

/// Best pose in the window on a lattice of cells and angle steps (a step moves the farthest point by a cell),
/// found exactly by branch and bound: Hess et al. 2016, Algorithm 3. `points` in the scan's frame; nothing
/// when no pose scores above the minimum.
std::optional<SearchResult> correlativeSearch(const ScorePyramid& pyramid, const Points2& points,
                                              const Pose2& grid_from_scan, const SearchWindow& window,
                                              const std::optional<ExcludedPose>& excluded = std::nullopt);

}  // namespace roomgraph
