// SPDX-License-Identifier: BSD-3-Clause
// Records put in time order within a look-ahead.
#pragma once

#include <deque>
#include <optional>

#include "roomgraph/datasets/record_stream.h"

namespace roomgraph {

/// Puts records in order of time within a short look-ahead. At equal times wheel odometry and recorded
/// detections come first, then scans, then frames: what a frame needs is there when it is processed.
class RecordSorter {
 public:
  explicit RecordSorter(double lookahead_s) : lookahead_s_(lookahead_s) {}
  void push(Record record);
  /// The next record if nothing earlier can still come (or `flush`: the input has ended).
  std::optional<Record> pop(bool flush);

 private:
  double lookahead_s_;
  double latest_ = 0;
  std::deque<Record> waiting_;
};

}  // namespace roomgraph
