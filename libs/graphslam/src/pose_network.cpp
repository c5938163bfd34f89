// SPDX-License-Identifier: BSD-3-Clause
// Factor graph of a pose network.
#include "roomgraph/graphslam/pose_network.h"

namespace roomgraph {

SolveReport optimize(PoseNetwork& network, const SolveOptions& options) {
  FactorGraph graph;
  for (const auto& [id, pose] : network.poses) {
    graph.addPose(id, pose, id == network.root);
    if (network.planar && id != network.root) graph.add(PlanarFactor{id});
  }
  for (const auto& edge : network.edges) graph.add(edge);
  const SolveReport report = graph.optimize(options);
  if (!report.usable) return report;
  for (auto& [id, pose] : network.poses) {
    pose = graph.pose(id);
    if (network.planar) pose = toPose3(planarPart(pose));
  }
  return report;
}

}  // namespace roomgraph
