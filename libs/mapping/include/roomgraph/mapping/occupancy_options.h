// SPDX-License-Identifier: BSD-3-Clause
// Options of the occupancy grid: sources, resolution, beam model, choice of scans.
#pragma once

#include <string>

#include "roomgraph/core/parameters.h"
#include "roomgraph/mapping/range_fan.h"

namespace roomgraph {

/// [mapping]
struct OccupancyOptions : Configurable {
  std::string source = "auto";
  double resolution_m = 0.05;
  double max_range_m = 12;
  double no_return_free_m = 4;
  double hit_probability = 0.7, pass_probability = 0.45;
  double min_move_m = 0.1, min_turn_rad = 0.1, max_wait_s = 2;
  DepthSlice slice;
  bool leave_out_moving = true;
  void declareParameters(ParameterVisitor& v) override;
};

}  // namespace roomgraph
