// SPDX-License-Identifier: BSD-3-Clause
// Replay loop over sorted records, which are read and looked at on a thread beside it, and the share of the
// span done.
#include "roomgraph/pipeline/replay.h"

#include <algorithm>
#include <limits>
#include <opencv2/core/utility.hpp>

#include "roomgraph/pipeline/record_sorter.h"
#include "roomgraph/core/read_ahead.h"
#include "stage_borders.h"

namespace roomgraph {
namespace {

constexpr std::size_t kAhead = 12;  // records that wait at most; an image with what is known of it has 4 MB

/// A record whose turn comes.
struct Upcoming {
  Record record;
  double progress = 0;  ///< of the stream, when it was read
  Work reading, foreseeing;
};

/// Reads the records in order of time, as far as the look-ahead goes, up to the first one behind the span.
class SpanReader {
 public:
  SpanReader(RecordStream& stream, SemanticSlam& slam, const ReplaySpan& span, bool foresees)
      : stream_(stream),
        slam_(slam),
        span_(span),
        foresees_(foresees),
        sorter_(slam.setup().options.general.lookahead_s) {}

  std::optional<Upcoming> next() {
    if (behind_) return std::nullopt;
    const Meter reading;
    auto record = nextInOrder();
    if (!record) return std::nullopt;
    if (!hasTime(*record)) return Upcoming{std::move(*record), stream_.progress(), {}, {}};
    // Boxes come before their images, with the stamps of their own.
    const double t = timeOf(*record);
    const bool boxes = isBoxes(*record);
    if (!start_ && !boxes) start_ = t;
    behind_ = !boxes && span_.until_s > 0 && t - *start_ > span_.until_s;
    Upcoming out{std::move(*record), stream_.progress(), {}, {}};
    out.reading = reading.soFar();
    if (foresees_ && !boxes && !behind_ && t - *start_ >= span_.from_s) {
      const Meter foreseeing;
      slam_.foresee(out.record);
      out.foreseeing = foreseeing.soFar();
    }
    return out;
  }

 private:
  std::optional<Record> nextInOrder() {
    while (true) {
      if (auto record = sorter_.pop(ended_)) return record;
      if (ended_) return std::nullopt;
      if (auto read = stream_.next(); read && !hasTime(*read))
        return read;  // it has no place in an order
      else if (read)
        sorter_.push(std::move(*read));
      else
        ended_ = true;
    }
  }

  RecordStream& stream_;
  SemanticSlam& slam_;
  ReplaySpan span_;
  bool foresees_, ended_ = false, behind_ = false;
  RecordSorter sorter_;
  std::optional<double> start_;
};

bool isImage(const Record& record) {
  return std::holds_alternative<Frame>(record);
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
  const double until_s = span.until_s > 0 ? span.until_s : std::numeric_limits<double>::infinity();
  std::optional<double> start;
  bool began = false;
  double file_from = 0;
  const bool beside = cv::getNumThreads() > 1;
  SpanReader reader(stream, slam, span, beside);
  ReadAhead<Upcoming> ahead([&] { return reader.next(); }, beside ? kAhead : 0);
  Work reading;
  while (!(state.interrupted = watch.interrupted())) {
    const auto next = ahead.next();
    if (!next) break;
    if (!hasTime(next->record)) {  // which is counted
      slam.process(next->record);
      continue;
    }
    const double t = timeOf(next->record);
    if (isBoxes(next->record)) {  // before their images, as they may be stamped later: time neither begins nor ends with them
      const double since = start ? t - *start : 0;
      if (since < span.from_s || since > until_s) continue;
      ++state.records;
      slam.process(next->record);
      continue;
    }
    if (!start) state.start_t = *(start = t);
    if (t - *start > until_s) break;
    state.last_t = t;
    if (t - *start < span.from_s) continue;
    ++state.records;
    if (!began) {
      began = true;
      state.first_t = t;
      file_from = next->progress;
    }
    slam.process(next->record);
    reading.add(next->reading);
    if (isImage(next->record)) {  // with what was read since the last one
      slam.account("reading", reading);
      reading = {};
    }
    if (next->foreseeing.ms > 0 && (isImage(next->record) || std::holds_alternative<Scan>(next->record)))
      slam.account("foreseeing", next->foreseeing);
    state.share = shareDone(next->progress, file_from, state.seconds(), span);
    watch.progress(state);
  }
  return state;
}

}  // namespace roomgraph
