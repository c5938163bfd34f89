// SPDX-License-Identifier: BSD-3-Clause
// Building and solving of a graph from copies, in another thread or this one.
#include "live_solve.h"

#include <utility>

namespace roomgraph {

LiveSolve::LiveSolve(const KeyPoses& poses, const Motion& motion, const Measurements& measurements,
                     ObjectsAtPoses objects, const BackendOptions& options, const SolveOptions& until)
    : motion_(motion),
      poses_(poses, motion_),
      measurements_(measurements),
      objects_(std::move(objects)),
      options_(options),
      until_(until) {}

void LiveSolve::goBeside() {
  beside_ = std::async(std::launch::async, [this] { return buildAndSolve(); });
}

SolveReport LiveSolve::solve() { return beside_.valid() ? beside_.get() : buildAndSolve(); }

FactorGraph& LiveSolve::graph() {
  if (graph_) return *graph_;
  const ObjectsInGraph objects = objects_(poses_);
  graph_ = std::make_unique<FactorGraph>(buildGraph(poses_, motion_, measurements_, objects, options_));
  for (const Landmark& landmark : objects.landmarks)
    if (graph_->hasLandmark(landmark.id)) landmarks_.push_back(landmark.id);
  return *graph_;
}

SolveReport LiveSolve::buildAndSolve() {
  const Meter meter;
  SolveReport report = graph().optimize(until_);
  work_ = meter.soFar();
  return report;
}

}  // namespace roomgraph
