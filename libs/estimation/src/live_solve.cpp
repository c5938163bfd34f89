// SPDX-License-Identifier: BSD-3-Clause
// Building and solving of a graph from copies, in another thread or this one.
#include "live_solve.h"

#include <system_error>
#include <utility>

namespace roomgraph {

LiveSolve::LiveSolve(const KeyPoses& poses, const Motion& motion, const Measurements& measurements,
                     ObjectsAtPoses objects, const BackendOptions& options, std::size_t free, const SolveOptions& until)
    : motion_(motion),
      poses_(poses, motion_),
      measurements_(measurements),
      objects_(std::move(objects)),
      options_(options),
      free_(free),
      until_(until) {}

void LiveSolve::goBeside() {
  const auto work = [this] {
    const Meter meter;
    build();
    SolveReport report = graph_->optimize(until_);
    work_ = meter.soFar();
    return report;
  };
  try {
    beside_ = std::async(std::launch::async, work);
  } catch (const std::system_error&) {
    // The system has no more threads: solve() does it.
  }
}

SolveReport LiveSolve::solve() { return beside_.valid() ? beside_.get() : graph().optimize(until_); }

FactorGraph& LiveSolve::graph() {
  if (beside_.valid()) beside_.wait();
  if (!graph_) build();
  return *graph_;
}

void LiveSolve::build() {
  const ObjectsInGraph objects = objects_(poses_);
  graph_ = std::make_unique<FactorGraph>(buildGraph(poses_, motion_, measurements_, objects, options_, nullptr, free_));
  landmarks_ = landmarksIn(*graph_, objects);
  measurements_ = {};  // the graph has them, and is large enough
}

}  // namespace roomgraph
