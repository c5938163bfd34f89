// SPDX-License-Identifier: BSD-3-Clause
// Poses of the local maps that images and scans are matched against, as variables of the graph.
#pragma once

#include <vector>

#include "roomgraph/backend/factor_graph.h"
#include "roomgraph/estimation/key_poses.h"
#include "roomgraph/estimation/motion.h"
#include "roomgraph/estimation/options.h"

namespace roomgraph {

constexpr double kSourceGap_s = 0.25;  ///< a source that was silent for longer does not cover the time

/// What a source matched against one local map: consecutive key poses, [first, end) of all.
struct LocalMap {
  NodeId id;
  std::size_t first =
      0;  ///< where the map begins: its own pose is that of the robot there, as the source saw it
  std::size_t end = 0;
  bool follows = false;  ///< the source also covers the movement from the beginning of the map before it
};

/// Local maps of `source` that hold the key poses from `since` on, by time; the first may begin earlier. A
/// new one begins every `options.local_map_nodes` key poses and where the source does not cover the movement.
/// `since` does not change where: the same key poses give the same maps.
std::vector<LocalMap> localMaps(const KeyPoses& poses, const MotionSource& source, NodeId first_id,
                                std::size_t since, const BackendOptions& options);

/// Ids of the local maps, of images and of scans, that hold key poses from `since` on and begin before `end`.
std::vector<NodeId> localMapIds(const KeyPoses& poses, const Motion& motion, std::size_t since,
                                std::size_t end, const BackendOptions& options);

/// Local maps of images and of scans as poses, and their factors: key poses from `since` on as seen in their
/// map, and the beginning of each map as seen from the one before, with the drift between them (method.md
/// sec. 4.4, factor 1).
void addLocalMaps(FactorGraph& graph, const KeyPoses& poses, const Motion& motion, std::size_t since,
                  const BackendOptions& options);

}  // namespace roomgraph
