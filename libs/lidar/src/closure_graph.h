// SPDX-License-Identifier: BSD-3-Clause
// Graph of kept scans and closures; shortest path lengths as bound on drift.
#pragma once

#include <limits>
#include <vector>

#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// Graph of the kept scans: odometry edges between successive ones, and loop closures. The length of the
/// shortest path between two scans bounds the drift between them; the edges along it give their relative
/// pose.
class ClosureGraph {
 public:
  struct Reached {
    double length_m = std::numeric_limits<double>::infinity();  ///< infinite: not connected
    Pose2 start_from_node;                                      ///< movement composed along the shortest path
  };

  /// Adds a node after the last one; `connected`: the movement between them is known.
  void addNode(bool connected, const Pose2& last_from_this, double length_m);
  void addClosure(int a, int b, const Pose2& a_from_b, double length_m);
  int size() const { return static_cast<int>(edges_.size()); }
  /// Shortest paths from `start` to every node (Dijkstra), ties broken by the lower number.
  std::vector<Reached> reachedFrom(int start) const;

 private:
  struct Edge {
    int to;
    double length_m;
    Pose2 from_to;
  };
  void join(int a, int b, const Pose2& a_from_b, double length_m);
  std::vector<std::vector<Edge>> edges_;
};

}  // namespace roomgraph
