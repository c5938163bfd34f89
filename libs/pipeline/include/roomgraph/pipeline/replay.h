// SPDX-License-Identifier: BSD-3-Clause
// Replay of a span of a recording through SemanticSlam, with progress and interruption.
#pragma once

#include <functional>

#include "roomgraph/datasets/record_stream.h"
#include "roomgraph/pipeline/semantic_slam.h"

namespace roomgraph {

/// Which part of a recording is replayed, in seconds after its first record.
struct ReplaySpan {
  double from_s = 0;
  double until_s = 0;  ///< 0: to the end
};

/// How far a replay is, or came.
struct ReplayState {
  int records = 0;                 ///< processed
  double start_t = 0;              ///< s; time of the first record of the recording
  double first_t = 0, last_t = 0;  ///< s; of the first and the last record processed
  double share = 0;                ///< of the span, [0, 1]
  bool interrupted = false;

  double seconds() const { return last_t - first_t; }
};

/// Who watches a replay.
struct ReplayWatch {
  std::function<void(const ReplayState&)> progress = [](const ReplayState&) {};  ///< after every record
  std::function<bool()> interrupted = [] { return false; };                      ///< before every record
};

/// Feeds the records of the span to `slam` in order of time; whoever wants to see what comes of them is a sink of it.
ReplayState replay(RecordStream& stream, SemanticSlam& slam, const ReplaySpan& span = {},
                   const ReplayWatch& watch = {});

}  // namespace roomgraph
