// SPDX-License-Identifier: BSD-3-Clause
// Chordal relaxation: initial poses of a pose graph from relative movements alone.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "roomgraph/core/ids.h"
#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// A movement with scalar weights (information) of its translation and rotation.
struct RelativeEdge {
  NodeId a, b;
  Pose3 a_from_b = Pose3::Identity();
  double translation_weight = 1, rotation_weight = 1;
};

/// Poses from relative movements without initial estimate (chordal relaxation: Martinec & Pajdla 2007; Carlone et al.,
/// ICRA 2015): rotation matrices as a linear least-squares problem, each then projected onto SO(3);
/// translations as a second one. `start` names the nodes; only the anchor's pose is used, and kept. Nothing
/// when the graph is not connected.
std::optional<std::map<NodeId, Pose3>> chordalPoses(const std::map<NodeId, Pose3>& start, NodeId anchor,
                                                    const std::vector<RelativeEdge>& edges);

}  // namespace roomgraph
