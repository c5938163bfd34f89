// SPDX-License-Identifier: BSD-3-Clause
// LiveSolve: an optimisation of the whole graph that goes on beside the run.
#pragma once

#include <future>
#include <memory>
#include <optional>
#include <vector>

#include "roomgraph/core/meter.h"
#include "roomgraph/estimation/pose_estimator.h"

namespace roomgraph {

/// Everything measured up to a key pose, being optimised. It holds copies of what the run goes on changing.
class LiveSolve {
 public:
  /// `options` outlives it. `free`: so many latest key poses have variables of their own.
  LiveSolve(const KeyPoses& poses, const Motion& motion, const Measurements& measurements, ObjectsAtPoses objects,
            const BackendOptions& options, std::size_t free, const SolveOptions& until);

  LiveSolve(const LiveSolve&) = delete;
  LiveSolve& operator=(const LiveSolve&) = delete;

  /// Begins in a thread of its own, where there is one to be had; otherwise solve() does the work.
  void goBeside();
  /// Optimises, or waits for the thread. Once.
  SolveReport solve();
  /// With everything where it was, if neither solve() nor a thread has changed that; waits for the thread.
  FactorGraph& graph();

  /// Key poses in the graph: the first ones of the run.
  std::size_t nodes() const { return poses_.nodes().size(); }
  /// In the graph, which there must be.
  const std::vector<LandmarkId>& landmarks() const { return landmarks_; }
  /// Of the thread, after solve(); nothing when there was none.
  const std::optional<Work>& workBeside() const { return work_; }

  /// The run's poses were moved since: its solution is that of another path.
  void outdate() { outdated_ = true; }
  bool outdated() const { return outdated_; }

 private:
  void build();

  Motion motion_;
  KeyPoses poses_;
  Measurements measurements_;
  ObjectsAtPoses objects_;
  const BackendOptions& options_;
  std::size_t free_;
  SolveOptions until_;
  std::unique_ptr<FactorGraph> graph_;
  std::vector<LandmarkId> landmarks_;
  std::optional<Work> work_;
  bool outdated_ = false;
  std::future<SolveReport> beside_;  // last: ends before what it uses
};

}  // namespace roomgraph
