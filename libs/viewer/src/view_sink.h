// SPDX-License-Identifier: BSD-3-Clause
// ViewSink: from the reports of a run to the states that a viewer shows.
#pragma once

#include <memory>

#include "live_grid.h"
#include "roomgraph/pipeline/semantic_slam.h"
#include "roomgraph/viewer/state_mailbox.h"

namespace roomgraph {

/// Copies after every frame and scan what is to be shown into the mailbox. Runs in the thread that maps, and
/// shares with the states before whatever did not change.
class ViewSink : public Sink {
 public:
  /// Run and mailbox outlive the sink.
  ViewSink(const SemanticSlam& slam, StateMailbox& mailbox);

  void onStep(const StepReport& report) override;
  /// After SemanticSlam::finish(): the map with all hindsight.
  void onResult(const SlamResult& result);

  /// Frames and scans so far.
  int records() const { return last_.record; }

 private:
  std::shared_ptr<const SeenFrame> see(const StepReport& report);
  void seeScan(const StepReport& report);
  void copyPath();
  void copyLandmarks();
  void put(std::shared_ptr<const SeenFrame> frame);

  const SemanticSlam& slam_;
  StateMailbox& mailbox_;
  LiveGrid grid_;
  ViewState last_;
  std::size_t closures_ = 0;  ///< of the run, links too, when last looked at
};

}  // namespace roomgraph
