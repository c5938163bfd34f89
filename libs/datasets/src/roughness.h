// SPDX-License-Identifier: BSD-3-Clause
// Bursts of noise: scans and depth images much rougher than the others of the recording.
#pragma once

#include <vector>

#include "roomgraph/datasets/rawlog_report.h"

namespace roomgraph {

/// Roughness of a line of ranges (m; 0: no return): median of |a - 2 b + c| over neighbours a, b, c. Walls
/// and furniture are straight lines or smooth curves for most of them, noise is not. 0 when there are too
/// few.
double roughnessOf(const std::vector<float>& ranges_m);

/// Collects the roughness of records and tells which stand out.
class RoughnessWatch {
 public:
  /// t in s.
  void add(double t, double roughness_m) { records_.push_back({t, roughness_m}); }
  /// Records several times as rough as the median one, and by more than sensors differ from wall to wall.
  PoorRecords noisy() const;

 private:
  struct Record {
    double t, roughness_m;
  };
  std::vector<Record> records_;
};

}  // namespace roomgraph
