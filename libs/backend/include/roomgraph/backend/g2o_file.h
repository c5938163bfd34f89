// SPDX-License-Identifier: BSD-3-Clause
// Reading and writing of pose graphs with landmarks in g2o text format.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <variant>

#include "roomgraph/backend/factor_graph.h"
#include "roomgraph/backend/planar_graph.h"

namespace roomgraph {

/// Content of a g2o file.
struct G2oContent {
  std::variant<PlanarGraph, FactorGraph> graph;  ///< 2D or 3D
  NodeTimes times;                               ///< of the poses that have one
  std::map<std::string, int> skipped;            ///< number of lines by unknown tag
};

/// Reads VERTEX_SE2 and EDGE_SE2, or VERTEX_SE3:QUAT and EDGE_SE3:QUAT, FIX, and the landmarks
/// and times of FactorGraph::saveG2o (docs/formats.md). Without FIX the first pose is held. Throws InputError
/// with file and line for every inconsistency: unreadable numbers, unknown or doubled vertices,
/// information that is not positive definite, 2D and 3D mixed.
G2oContent loadG2o(const std::filesystem::path& file);

/// VERTEX_SE2, FIX and EDGE_SE2, landmarks and times as comments. Throws RunError when the file cannot be
/// written.
void saveG2o(const PlanarGraph& graph, const std::filesystem::path& file, const NodeTimes& times = {});

}  // namespace roomgraph
