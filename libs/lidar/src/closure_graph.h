// SPDX-License-Identifier: BSD-3-Clause
// Graph of kept scans and closures; shortest path lengths as bound on drift.
#pragma once

#include <limits>
#include <vector>

#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// Graph of the kept scans: odometry edges between successive ones, and loop closures. The length of the
/// shortest path between two scans bounds the drift between them; the edges along it give their relative
/// pose. Nodes are numbered as they were added; what is taken out keeps its number.
class ClosureGraph {
 public:
  struct Reached {
    double length_m = std::numeric_limits<double>::infinity();  ///< infinite: not connected
    Pose2 start_from_node;                                      ///< movement composed along the shortest path
    int start = -1;                                             ///< where that path begins
  };

  /// Shortest paths to every node from the nearest of some.
  class Paths {
   public:
    /// Not connected when it was taken out.
    const Reached& operator[](int node) const;

   private:
    friend class ClosureGraph;
    explicit Paths(const ClosureGraph& graph) : graph_(&graph), reached_(graph.edges_.size()) {}
    const ClosureGraph* graph_;
    std::vector<Reached> reached_;  ///< by slot
  };

  /// Adds a node after the last one; `connected`: the movement between them is known.
  void addNode(bool connected, const Pose2& last_from_this, double length_m);
  /// Nothing when one of them was taken out.
  void addClosure(int a, int b, const Pose2& a_from_b, double length_m);
  /// Takes out a node, which must not be the last one. Its neighbours are joined by the way over it, unless another is at
  /// most `spare_m` longer: with none, the lengths of the shortest paths between the others stay; with some, few edges do.
  void remove(int node, double spare_m);
  /// Those added; those of them that are there.
  int size() const { return static_cast<int>(slots_.size()); }
  int held() const { return static_cast<int>(edges_.size() - free_.size()); }
  /// Each counted once.
  std::size_t edges() const;
  /// Dijkstra, ties broken by the lower number. The graph must not change while the paths are in use; what was taken out begins none.
  Paths reachedFrom(int start) const { return reachedFromAny({start}); }
  Paths reachedFromAny(const std::vector<int>& starts) const {
    return search(starts, std::numeric_limits<double>::infinity());
  }

 private:
  struct Edge {
    int to;  ///< slot
    double length_m;
    Pose2 from_to;
  };
  Paths search(const std::vector<int>& starts, double longest_m) const;
  int slotOf(int node) const { return slots_[static_cast<std::size_t>(node)]; }
  std::vector<Edge>& edgesOf(int slot) { return edges_[static_cast<std::size_t>(slot)]; }
  void join(int slot_a, int slot_b, const Pose2& a_from_b, double length_m);
  void part(int slot_a, int slot_b);
  void bridge(const std::vector<Edge>& neighbours, double spare_m);

  std::vector<int> slots_;                // by node; -1: taken out
  std::vector<std::vector<Edge>> edges_;  // by slot
  std::vector<int> nodes_;                // by slot
  std::vector<int> free_;                 // slots of what was taken out
};

}  // namespace roomgraph
