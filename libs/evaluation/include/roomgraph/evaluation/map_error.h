// SPDX-License-Identifier: BSD-3-Clause
// Agreement of an occupancy map with the true one, and distance of its walls.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include "roomgraph/evaluation/statistics.h"
#include "roomgraph/geometry/pose.h"

namespace roomgraph {

struct MapOptions {
  /// How far an occupied cell may be from the nearest of the other map: distance of the centres, rounded to
  /// whole cells of the coarser map (1: also the diagonal neighbours).
  int tolerance_cells = 1;
  double occupied_above = 0.65, free_below = 0.196;  ///< probabilities of being occupied, as in ROS
  Pose2 truth_from_map;                              ///< moves the estimated map before it is compared
};

/// All shares are 0 where nothing is to divide; the counts say so.
struct MapErrors {
  int estimated_occupied = 0, true_occupied = 0;  ///< cells of each map
  int checked_occupied = 0;                       ///< estimated occupied cells at places the truth knows …
  int correct_occupied = 0;                       ///< … within the tolerance of a true one
  int expected_occupied = 0;                      ///< true occupied cells at places the estimate knows …
  int found_occupied = 0;                         ///< … within the tolerance of an estimated one
  double precision = 0, recall = 0, f1 = 0;       ///< of occupied

  int known_in_both = 0;       ///< estimated cells known at a place the truth knows
  double agreement = 0;        ///< share of them with exactly the same state
  double free_precision = 0;   ///< share of the estimated free ones that are truly free
  double free_agreement = 0;   ///< share of the truly free ones that are estimated free
  double unknown_share = 0;    ///< share of the truth's known cells that the estimate does not know or cover
  ErrorStatistics to_truth_m;  ///< from each estimated occupied cell to the nearest true one
  ErrorStatistics to_map_m;    ///< from each true occupied cell to the nearest estimated one
};

/// Compares occupancy grids of any resolution and origin: states are looked up at the other map's cell
/// centres, distances are those of the centres. Cells: probability of being free, as MRPT keeps it.
MapErrors evaluateMap(const mrpt::maps::COccupancyGridMap2D& truth,
                      const mrpt::maps::COccupancyGridMap2D& map, const MapOptions& options = {});

}  // namespace roomgraph
