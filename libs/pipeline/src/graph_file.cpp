// SPDX-License-Identifier: BSD-3-Clause
// Choice of the planar or spatial graph, with the times of its nodes and what found its loop closures.
#include "graph_file.h"

#include <cerrno>
#include <fstream>

#include "roomgraph/backend/g2o_file.h"
#include "roomgraph/core/output_file.h"

namespace roomgraph {
namespace {

// "# CLOSURE a b kind" for each, in the order in which the graph has its edges, between the bodies that it ties.
void appendClosureKinds(const SemanticSlam& slam, const std::filesystem::path& file) {
  std::ofstream out(file, std::ios::app);
  const KeyPoses& poses = slam.keyPoses();
  for (const auto& closure : slam.loopClosures()) {
    if (closure.link) continue;
    const NodeId a = slam.graph().bodyOf(poses.nearest(closure.t_a).id), b = slam.graph().bodyOf(poses.nearest(closure.t_b).id);
    if (a != b) out << "# CLOSURE " << a << ' ' << b << ' ' << closure.source << '\n';
  }
  if (!out.flush()) failToWrite(file, errno);
}

}  // namespace

void saveGraph(const SemanticSlam& slam, bool planar_run, const std::filesystem::path& file) {
  NodeTimes times;
  for (const auto& node : slam.keyPoses().nodes()) times[node.id] = node.t;
  if (planar_run && slam.setup().options.backend.planar_graph)
    saveG2o(slam.graph().planar(), file, times);
  else
    slam.graph().saveG2o(file, times);
  appendClosureKinds(slam, file);
}

}  // namespace roomgraph
