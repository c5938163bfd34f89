// SPDX-License-Identifier: BSD-3-Clause
// Dijkstra's shortest paths with composed movements, and nodes that are taken out.
#include "closure_graph.h"

#include <algorithm>
#include <map>
#include <queue>
#include <tuple>
#include <utility>

namespace roomgraph {

const ClosureGraph::Reached& ClosureGraph::Paths::operator[](int node) const {
  static const Reached kNever;
  const int slot = graph_->slotOf(node);
  return slot < 0 ? kNever : reached_[static_cast<std::size_t>(slot)];
}

void ClosureGraph::addNode(bool connected, const Pose2& last_from_this, double length_m) {
  int slot = static_cast<int>(edges_.size());
  if (free_.empty()) {
    edges_.emplace_back();
    nodes_.push_back(size());
  } else {
    slot = free_.back();
    free_.pop_back();
    nodes_[static_cast<std::size_t>(slot)] = size();
  }
  slots_.push_back(slot);
  if (connected && size() > 1) join(slotOf(size() - 2), slot, last_from_this, length_m);
}

void ClosureGraph::addClosure(int a, int b, const Pose2& a_from_b, double length_m) {
  if (slotOf(a) >= 0 && slotOf(b) >= 0) join(slotOf(a), slotOf(b), a_from_b, length_m);
}

void ClosureGraph::join(int slot_a, int slot_b, const Pose2& a_from_b, double length_m) {
  edgesOf(slot_a).push_back({slot_b, length_m, a_from_b});
  edgesOf(slot_b).push_back({slot_a, length_m, a_from_b.inverse()});
}

std::size_t ClosureGraph::edges() const {
  std::size_t ends = 0;
  for (const auto& edges : edges_) ends += edges.size();
  return ends / 2;
}

void ClosureGraph::part(int slot_a, int slot_b) {
  std::erase_if(edgesOf(slot_a), [slot_b](const Edge& edge) { return edge.to == slot_b; });
  std::erase_if(edgesOf(slot_b), [slot_a](const Edge& edge) { return edge.to == slot_a; });
}

void ClosureGraph::remove(int node, double spare_m) {
  const int slot = slotOf(node);
  std::map<int, Edge> nearest;  // of several edges to one node only the shortest is on a shortest path
  for (const Edge& edge : edgesOf(slot)) {
    const auto [it, first] = nearest.emplace(edge.to, edge);
    if (!first && edge.length_m < it->second.length_m) it->second = edge;
  }
  std::vector<Edge> neighbours;
  for (const auto& [to, edge] : nearest) {
    neighbours.push_back(edge);
    part(slot, to);
  }
  edgesOf(slot).shrink_to_fit();
  slots_[static_cast<std::size_t>(node)] = -1;
  free_.push_back(slot);
  bridge(neighbours, spare_m);
}

// The way over a node that is taken out, in place of what joined two of its neighbours before.
void ClosureGraph::bridge(const std::vector<Edge>& neighbours, double spare_m) {
  for (auto a = neighbours.begin(); a != neighbours.end() && std::next(a) != neighbours.end(); ++a) {
    double longest_m = 0;
    for (auto b = std::next(a); b != neighbours.end(); ++b) longest_m = std::max(longest_m, a->length_m + b->length_m);
    const Paths others = search({nodes_[static_cast<std::size_t>(a->to)]}, longest_m + spare_m);
    for (auto b = std::next(a); b != neighbours.end(); ++b) {
      const double length_m = a->length_m + b->length_m;
      if (others.reached_[static_cast<std::size_t>(b->to)].length_m <= length_m + spare_m) continue;
      part(a->to, b->to);
      join(a->to, b->to, a->from_to.inverse() * b->from_to, length_m);
    }
  }
}

ClosureGraph::Paths ClosureGraph::search(const std::vector<int>& starts, double longest_m) const {
  Paths paths(*this);
  const auto reached = [&](int slot) -> Reached& { return paths.reached_[static_cast<std::size_t>(slot)]; };
  using Entry = std::tuple<double, int, int>;  // length, node, slot
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  for (const int start : starts) {
    if (slotOf(start) < 0) continue;
    reached(slotOf(start)) = {0, {}, start};
    open.emplace(0.0, start, slotOf(start));
  }
  while (!open.empty()) {
    const auto [length, node, slot] = open.top();
    open.pop();
    const Reached here = reached(slot);
    if (length > here.length_m) continue;
    for (const Edge& edge : edges_[static_cast<std::size_t>(slot)]) {
      Reached& there = reached(edge.to);
      const double length_m = length + edge.length_m;
      if (length_m >= there.length_m || length_m > longest_m) continue;
      there = {length_m, here.start_from_node * edge.from_to, here.start};
      open.emplace(length_m, nodes_[static_cast<std::size_t>(edge.to)], edge.to);
    }
  }
  return paths;
}

}  // namespace roomgraph
