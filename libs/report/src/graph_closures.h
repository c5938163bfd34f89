// SPDX-License-Identifier: BSD-3-Clause
// Loop closures of a run from its pose graph file.
#pragma once

#include <istream>

#include "run_data.h"

namespace roomgraph {

/// Edges of graph.g2o between two key poses (vertices with a stamp) that do not follow each other. Lines that
/// are none of the format are stepped over. Times count from `start_t`.
std::vector<ClosedLoop> readClosures(std::istream& graph, double start_t);

}  // namespace roomgraph
