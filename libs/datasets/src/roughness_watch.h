// SPDX-License-Identifier: BSD-3-Clause
// Bursts of noise: scans and depth images much rougher than the others of the recording.
#pragma once

#include <vector>

#include "roomgraph/datasets/rawlog_report.h"

namespace roomgraph {

/// Collects the roughness of records and tells which stand out.
class RoughnessWatch {
 public:
  /// t in s.
  void add(double t, double roughness_m) { records_.push_back({t, roughness_m}); }
  /// Records that stand out from the median one (roughnessLimit).
  PoorRecords noisy() const;

 private:
  struct Record {
    double t, roughness_m;
  };
  std::vector<Record> records_;
};

}  // namespace roomgraph
