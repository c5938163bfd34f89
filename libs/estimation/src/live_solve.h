// SPDX-License-Identifier: BSD-3-Clause
// LiveSolve: an optimisation of the whole graph that goes on beside the run.
#pragma once

#include <future>
#include <memory>
#include <vector>

#include "roomgraph/core/meter.h"
#include "roomgraph/estimation/pose_estimator.h"

namespace roomgraph {

/// Everything measured up to a key pose, being optimised. It holds copies of what the run goes on changing.
class LiveSolve {
 public:
  /// `options` outlives it.
  LiveSolve(const KeyPoses& poses, const Motion& motion, const Measurements& measurements, ObjectsAtPoses objects,
            const BackendOptions& options, const SolveOptions& until);

  /// Begins in a thread of its own; otherwise solve() does the work. Once, and before the other calls.
  void goBeside();
  /// Optimises, or waits for the thread. Once.
  SolveReport solve();
  /// Begins with everything where it was, if solve() was not called. Not after goBeside().
  FactorGraph& graph();

  /// Key poses in the graph: the first ones of the run.
  std::size_t nodes() const { return poses_.nodes().size(); }
  /// In the graph, which there must be.
  const std::vector<LandmarkId>& landmarks() const { return landmarks_; }
  /// Of solve(), wherever it was done.
  const Work& work() const { return work_; }

  bool outdated = false;  ///< the run's poses were moved since, otherwise than by takeOver(): nothing fits any more

 private:
  SolveReport buildAndSolve();

  Motion motion_;
  KeyPoses poses_;
  Measurements measurements_;
  ObjectsAtPoses objects_;
  const BackendOptions& options_;
  SolveOptions until_;
  std::unique_ptr<FactorGraph> graph_;
  std::vector<LandmarkId> landmarks_;
  Work work_;
  std::future<SolveReport> beside_;  // last: ends before what it uses
};

}  // namespace roomgraph
