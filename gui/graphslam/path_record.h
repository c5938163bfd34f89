// SPDX-License-Identifier: BSD-3-Clause
// The robot's path between the nodes of an engine's graph.
#pragma once

#include <cmath>
#include <vector>

#include "semantic_annotations.h"

namespace roomgraph {

/// Where the robot was at each scan and image, relative to the node before: the path follows the nodes wherever later
/// edges move them.
template <class GRAPH>
class PathRecord {
 public:
  /// `world_from_robot`: as the engine sees it with the nodes as they are. Ignores a time that is not later.
  void add(double t, const GRAPH& graph, const Pose3& world_from_robot) {
    if (std::isnan(t) || (!path_.empty() && t <= path_.back().t)) return;
    const auto node = graph.nodes.empty() ? mrpt::graphs::TNodeID(0) : graph.nodes.rbegin()->first;
    const Pose3 base = graph.nodes.empty() ? Pose3::Identity() : poseOf(graph.nodes.rbegin()->second);
    path_.push_back({t, node, base.inverse() * world_from_robot});
  }

  std::vector<StampedPose> poses(const GRAPH& graph) const {
    std::vector<StampedPose> out;
    for (const auto& [t, node, node_from_robot] : path_)
      out.push_back({t, poseOf(graph.nodes.at(node)) * node_from_robot});
    return out;
  }

 private:
  struct Place {
    double t;
    mrpt::graphs::TNodeID node;
    Pose3 node_from_robot;
  };
  std::vector<Place> path_;
};

}  // namespace roomgraph
