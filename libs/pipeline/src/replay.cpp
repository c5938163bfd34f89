// SPDX-License-Identifier: BSD-3-Clause
// Replay loop over sorted records, and the share of the span done.
#include "roomgraph/pipeline/replay.h"

#include <algorithm>
#include <limits>

#include "record_sorter.h"

namespace roomgraph {
namespace {

// Records in order of time, as far as the look-ahead goes.
std::optional<Record> nextInOrder(RecordStream& stream, RecordSorter& sorter, bool& ended) {
  while (true) {
    if (auto record = sorter.pop(ended)) return record;
    if (ended) return std::nullopt;
    if (auto read = stream.next())
      sorter.push(std::move(*read));
    else
      ended = true;
  }
}

// By the file from where the span begins in it, or by time, whichever is farther: the file may end first.
double shareDone(double file_share, double file_from, double seconds, const ReplaySpan& span) {
  const double by_file = file_from < 1 ? (file_share - file_from) / (1 - file_from) : span.until_s <= 0;
  const double by_time = span.until_s > 0 ? seconds / (span.until_s - span.from_s) : 0;
  return std::clamp(std::max(by_file, by_time), 0.0, 1.0);
}

}  // namespace

ReplayState replay(RecordStream& stream, SemanticSlam& slam, const ReplaySpan& span,
                   const ReplayWatch& watch) {
  ReplayState state;
  RecordSorter sorter(slam.setup().options.general.lookahead_s);
  const double until_s = span.until_s > 0 ? span.until_s : std::numeric_limits<double>::infinity();
  std::optional<double> start;
  double file_from = 0;
  bool ended = false;
  while (!(state.interrupted = watch.interrupted())) {
    const auto record = nextInOrder(stream, sorter, ended);
    if (!record) break;
    const double t = timeOf(*record);
    if (!start) state.start_t = *(start = t);
    if (t - *start > until_s) break;
    state.last_t = t;
    if (t - *start < span.from_s) continue;
    if (state.records++ == 0) {
      state.first_t = t;
      file_from = stream.progress();
    }
    slam.process(*record);
    state.share = shareDone(stream.progress(), file_from, state.seconds(), span);
    watch.progress(state);
  }
  return state;
}

}  // namespace roomgraph
