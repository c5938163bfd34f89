// SPDX-License-Identifier: BSD-3-Clause
// Choice of the planar or spatial graph, with the times of its nodes.
#include "graph_file.h"

#include "roomgraph/backend/g2o_file.h"

namespace roomgraph {

void saveGraph(const SemanticSlam& slam, bool planar_run, const std::filesystem::path& file) {
  NodeTimes times;
  for (const auto& node : slam.keyPoses().nodes()) times[node.id] = node.t;
  if (planar_run && slam.setup().options.backend.planar_graph)
    saveG2o(slam.graph().planar(), file, times);
  else
    slam.graph().saveG2o(file, times);
}

}  // namespace roomgraph
