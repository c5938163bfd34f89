// SPDX-License-Identifier: BSD-3-Clause
// Dijkstra's shortest paths with composed movements.
#include "closure_graph.h"

#include <queue>
#include <utility>

namespace roomgraph {

void ClosureGraph::addNode(bool connected, const Pose2& last_from_this, double length_m) {
  edges_.emplace_back();
  if (connected && size() > 1) join(size() - 2, size() - 1, last_from_this, length_m);
}

void ClosureGraph::addClosure(int a, int b, const Pose2& a_from_b, double length_m) {
  join(a, b, a_from_b, length_m);
}

void ClosureGraph::join(int a, int b, const Pose2& a_from_b, double length_m) {
  edges_[static_cast<std::size_t>(a)].push_back({b, length_m, a_from_b});
  edges_[static_cast<std::size_t>(b)].push_back({a, length_m, a_from_b.inverse()});
}

std::vector<ClosureGraph::Reached> ClosureGraph::reachedFrom(int start) const {
  std::vector<Reached> reached(edges_.size());
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  reached[static_cast<std::size_t>(start)].length_m = 0;
  open.emplace(0.0, start);
  while (!open.empty()) {
    const auto [length, node] = open.top();
    open.pop();
    const Reached here = reached[static_cast<std::size_t>(node)];
    if (length > here.length_m) continue;
    for (const Edge& edge : edges_[static_cast<std::size_t>(node)]) {
      Reached& there = reached[static_cast<std::size_t>(edge.to)];
      if (length + edge.length_m >= there.length_m) continue;
      there = {length + edge.length_m, here.start_from_node * edge.from_to};
      open.emplace(there.length_m, edge.to);
    }
  }
  return reached;
}

}  // namespace roomgraph
