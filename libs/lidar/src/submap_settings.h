// SPDX-License-Identifier: BSD-3-Clause
// Parameters of submaps and of scan thinning, shared by matcher and loop closer.
#pragma once

#include "active_submaps.h"
#include "roomgraph/core/parameters.h"

namespace roomgraph {

/// Which returns and scans are used, and how they become submaps: what matcher and loop closer have in
/// common.
struct SubmapSettings {
  double min_range_m = 0.1, max_range_m = 30;
  double cell_m = 0.05;
  int scans_per_submap = 60;
  double hit_probability = 0.6, miss_probability = 0.48;
  double keep_distance_m = 0.1, keep_angle_rad = 0.10472, keep_time_s = 5;
  double thinning_m = 0.05;
  int max_points = 200, min_points = 20;

  void declare(ParameterVisitor& v);
  std::unique_ptr<ActiveSubmaps> emptySubmaps() const;
  MotionFilter filter() const;
  PlanarScan planar(const Scan& scan) const;
  /// Returns to match, robot frame.
  Points2 points(const PlanarScan& scan) const;
};

}  // namespace roomgraph
