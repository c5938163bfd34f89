// SPDX-License-Identifier: BSD-3-Clause
// Poses of the local maps that images and scans are matched against, as variables of the graph.
#pragma once

#include <vector>

#include "roomgraph/estimation/graph_builder.h"

namespace roomgraph {

constexpr double kSourceGap_s = 0.25;  ///< a source that was silent for longer does not cover the time

/// Whether the pose is a local map's, and not a key pose.
bool isLocalMap(NodeId id);

/// Local maps of `source` that hold the key poses from `since` on, by time; the first may begin earlier. A
/// new one begins every `options.local_map_nodes` key poses and where the source does not cover the movement.
/// `since` does not change where, but later data of the source may: poses are interpolated over what it
/// missed.
std::vector<LocalMap> localMaps(const KeyPoses& poses, const MotionSource& source, NodeId first_id,
                                std::size_t since, const BackendOptions& options);

/// Local maps of images and of scans as poses, and their factors: key poses from `since` on as seen in their
/// map, and the beginning of each map as seen from the one before, with the drift between them (method.md
/// sec. 4.4, factor 1). A map whose key poses are some of those of a longer body moves along: it has no variables. Returns them.
std::vector<LocalMap> addLocalMaps(FactorGraph& graph, const KeyPoses& poses, const Motion& motion,
                                   std::size_t since, const BackendOptions& options);

}  // namespace roomgraph
