// SPDX-License-Identifier: BSD-3-Clause
// Poses and movements of an engine's graph, solved by our back end.
#pragma once

#include <map>
#include <vector>

#include "roomgraph/backend/factor_graph.h"

namespace roomgraph {

/// Nodes and edges of one of MRPT's pose networks.
struct PoseNetwork {
  std::map<NodeId, Pose3> poses;  ///< world_from_robot
  std::vector<BetweenFactor> edges;
  NodeId root{0};       ///< held
  bool planar = false;  ///< z, roll and pitch of every pose are 0
};

/// Robust least squares over all poses but the root (method.md Eq. 9). Takes over the solution when it is usable;
/// a planar one without what is left of height and tilt. Throws std::out_of_range for an edge between unknown poses.
SolveReport optimize(PoseNetwork& network, const SolveOptions& options = {});

}  // namespace roomgraph
