// SPDX-License-Identifier: BSD-3-Clause
// LiveReplay: a recording that is replayed in a thread of its own, for people who watch.
#pragma once

#include <atomic>
#include <exception>
#include <memory>
#include <thread>

#include "roomgraph/datasets/record_stream.h"
#include "roomgraph/pipeline/replay.h"
#include "roomgraph/viewer/replay_control.h"
#include "roomgraph/viewer/state_mailbox.h"

namespace roomgraph {

/// Runs replay() as `run` does, waits where the control says so, and puts states into the mailbox. The last
/// one is the result with all hindsight.
class LiveReplay {
 public:
  enum class Phase { kReplaying, kRefining, kEnded };

  LiveReplay(std::unique_ptr<RecordStream> stream, std::unique_ptr<Setup> setup, const ReplaySpan& span = {});
  /// Ends the replay where it is.
  ~LiveReplay();
  LiveReplay(const LiveReplay&) = delete;
  LiveReplay& operator=(const LiveReplay&) = delete;

  ReplayControl& control() { return control_; }
  StateMailbox& mailbox() { return mailbox_; }
  const ObjectDatabase& database() const { return slam_.setup().database; }
  Phase phase() const { return phase_; }
  /// Of the span that was replayed, [0, 1].
  double share() const { return share_; }
  /// Throws what ended the replay before its time, if anything did. Only after kEnded.
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  void work(const ReplaySpan& span);

  std::unique_ptr<RecordStream> stream_;
  SemanticSlam slam_;
  ReplayControl control_;
  StateMailbox mailbox_;
  std::atomic<Phase> phase_{Phase::kReplaying};
  std::atomic<double> share_{0};
  std::exception_ptr error_;
  std::thread thread_;
};

}  // namespace roomgraph
