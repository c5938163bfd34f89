// SPDX-License-Identifier: BSD-3-Clause
// Fixed-lag smoother over FactorGraph::marginalize for the tests.
#pragma once

#include <algorithm>
#include <deque>

#include "roomgraph/backend/factor_graph.h"

namespace roomgraph::test {

/// Fixed-lag smoothing with FactorGraph::marginalize, as a user of the library would write it: the last poses
/// and all landmarks are kept, what leaves the window stays as a prior.
class SlidingWindow {
 public:
  explicit SlidingWindow(std::size_t size, bool keep_prior = true, double tolerance = 1e-13)
      : size_(size), keep_prior_(keep_prior), tolerance_(tolerance) {}

  void addLandmark(LandmarkId id, const LandmarkEstimate& start) { landmarks_[id] = start; }

  /// A pose with its measurements, all of which reach back at most to the window's oldest pose.
  void step(NodeId id, const Pose3& start, const std::vector<Factor>& factors) {
    poses_[id] = start;
    factors_.insert(factors_.end(), factors.begin(), factors.end());
    shrink();
    build();
    graph_.optimize(SolveOptions{50, tolerance_});
    for (auto& [node, pose] : poses_) pose = graph_.pose(node);
    for (auto& [name, landmark] : landmarks_) landmark = graph_.landmark(name);
  }

  const FactorGraph& graph() const { return graph_; }

 private:
  void shrink() {
    if (poses_.size() <= size_) return;
    const NodeId oldest = poses_.begin()->first;
    Variables keep;
    for (const auto& [node, pose] : poses_)
      if (node != oldest && node != poses_.rbegin()->first) keep.nodes.push_back(node);
    for (const auto& [name, landmark] : landmarks_) keep.landmarks.push_back(name);
    if (keep_prior_) prior_ = graph_.marginalize(keep);
    poses_.erase(oldest);
    std::erase_if(factors_, [&](const Factor& factor) { return touches(factor, oldest); });
  }

  void build() {
    graph_ = FactorGraph();
    const bool first = !prior_;
    for (const auto& [node, pose] : poses_)
      graph_.addPose(node, pose, first && node == poses_.begin()->first);
    for (const auto& [name, landmark] : landmarks_) graph_.addLandmark(name, landmark);
    for (const auto& factor : factors_) graph_.add(factor);
    if (prior_) graph_.add(*prior_);
  }

  static bool touches(const Factor& factor, NodeId node) {
    if (const auto* f = std::get_if<BetweenFactor>(&factor)) return f->a == node || f->b == node;
    if (const auto* f = std::get_if<LandmarkFactor>(&factor)) return f->node == node;
    if (const auto* f = std::get_if<PlanarFactor>(&factor)) return f->node == node;
    return false;
  }

  std::size_t size_;
  bool keep_prior_;
  double tolerance_;
  std::map<NodeId, Pose3> poses_;
  std::map<LandmarkId, LandmarkEstimate> landmarks_;
  std::vector<Factor> factors_;
  std::optional<MarginalPrior> prior_;
  FactorGraph graph_;
};

}  // namespace roomgraph::test
