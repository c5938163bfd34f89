// SPDX-License-Identifier: BSD-3-Clause
// The replay's thread: turns, share, hindsight, errors.
#include "roomgraph/viewer/live_replay.h"

#include "view_sink.h"

namespace roomgraph {

LiveReplay::LiveReplay(std::unique_ptr<RecordStream> stream, std::unique_ptr<Setup> setup,
                       const ReplaySpan& span)
    : stream_(std::move(stream)), slam_(std::move(setup)), thread_([this, span] { work(span); }) {}

LiveReplay::~LiveReplay() {
  control_.stop();
  thread_.join();
}

void LiveReplay::work(const ReplaySpan& span) {
  try {
    if (const auto& generator = slam_.setup().stages.proposal_generator) generator->keepTraces(true);
    const auto sink = std::make_shared<ViewSink>(slam_, mailbox_);
    slam_.addSink(sink);
    std::optional<double> last_t;
    const auto progress = [&](const ReplayState& state) {
      last_t = state.last_t;
      share_ = state.share;
    };
    const auto ended = [&] { return !control_.waitForTurn(last_t, sink->records()); };
    const ReplayState replayed = replay(*stream_, slam_, span, {progress, ended});
    if (!replayed.interrupted && sink->records() > 0) {
      phase_ = Phase::kRefining;
      share_ = 1;
      sink->onResult(slam_.finish());
    }
  } catch (...) {
    error_ = std::current_exception();
  }
  phase_ = Phase::kEnded;
}

}  // namespace roomgraph
