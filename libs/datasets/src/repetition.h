// SPDX-License-Identifier: BSD-3-Clause
// Records in a row whose content is the same: a sensor that hangs.
#pragma once

#include <cstddef>
#include <string_view>

#include "roomgraph/datasets/rawlog_report.h"

namespace roomgraph {

/// Finds the longest run of records in a row with the same content. Real sensors have noise: even before a
/// wall no two of their records are the same.
class Repetition {
 public:
  /// A record at time t (s); `content` is what tells it from others.
  void add(double t, std::string_view content);
  /// The run that lasts longest; of two with one length the first.
  const SameRecords& longest() const { return longest_; }

 private:
  SameRecords longest_, current_;
  std::size_t hash_ = 0;
};

}  // namespace roomgraph
