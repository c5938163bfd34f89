// SPDX-License-Identifier: BSD-3-Clause
// Agreement of an occupancy map with the true one, and distance of its walls.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include "roomgraph/evaluation/statistics.h"
#include "roomgraph/geometry/pose.h"

namespace roomgraph {

struct MapOptions {
  /// Largest distance of an occupied cell from the nearest of the other map: of the centres, rounded to whole cells of
  /// the coarser map (1: also the diagonal neighbours).
  int tolerance_cells = 1;
  double occupied_above = 0.65, free_below = 0.196;  ///< probabilities of being occupied, as in ROS
  Pose2 truth_from_map;                              ///< moves the estimated map before it is compared
};

/// Shares are 0 where the denominator, which is among the counts, is 0.
struct MapErrors {
  int estimated_occupied = 0, true_occupied = 0;  ///< cells of each map
  int checked_occupied = 0;                       ///< estimated occupied cells where the truth is known …
  int correct_occupied = 0;                       ///< … within the tolerance of a true one
  int expected_occupied = 0;                      ///< true occupied cells where the estimate is known …
  int found_occupied = 0;                         ///< … within the tolerance of an estimated one
  double precision = 0, recall = 0, f1 = 0;       ///< of occupied

  int known_in_both = 0;       ///< estimated known cells where the truth is known
  double agreement = 0;        ///< share of them with exactly the same state
  double free_precision = 0;   ///< share of the estimated free ones that are truly free
  double free_agreement = 0;   ///< share of the truly free ones that are estimated free
  double unknown_share = 0;    ///< share of the truth's known cells that are unknown in the estimate or outside it
  ErrorStatistics to_truth_m;  ///< from each estimated occupied cell to the nearest true one
  ErrorStatistics to_map_m;    ///< from each true occupied cell to the nearest estimated one
};

/// Compares occupancy grids of any resolution and origin: states are looked up at the other map's cell
/// centres, distances are those of the centres. Cells: probability of being free, as MRPT keeps it.
MapErrors evaluateMap(const mrpt::maps::COccupancyGridMap2D& truth,
                      const mrpt::maps::COccupancyGridMap2D& map, const MapOptions& options = {});

}  // namespace roomgraph
