// SPDX-License-Identifier: BSD-3-Clause
// Records put in time order within a look-ahead.
#pragma once

#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "roomgraph/datasets/record_stream.h"

namespace roomgraph {

/// Whether a record holds recorded detections.
inline bool isBoxes(const Record& record) { return std::holds_alternative<std::shared_ptr<CObservationDetections>>(record); }

/// Puts records in order of time within a short look-ahead. At equal times wheel odometry comes first, then scans, then frames.
/// Recorded detections come earlier by .2 s, as what makes them may stamp them later than their image: what a frame needs is
/// there when it is processed. A stamp far ahead of all others, or those of one sensor, does not make the others late: time is there when
/// another kind of record is, or many.
class RecordSorter {
 public:
  explicit RecordSorter(double lookahead_s) : lookahead_s_(lookahead_s) {}
  void push(Record record);
  /// The next record if nothing earlier can still come (or `flush`: the input has ended).
  std::optional<Record> pop(bool flush);

 private:
  void note(const Record& record);

  double lookahead_s_;
  double latest_ = 0;           ///< up to where all have come
  bool boxes_come_ = false;     ///< detections are recorded
  std::deque<Record> waiting_;
  std::vector<std::pair<double, std::size_t>> ahead_;  ///< time and kind of those far ahead of `latest_` that have not moved it
};

}  // namespace roomgraph
