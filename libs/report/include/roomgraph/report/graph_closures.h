// SPDX-License-Identifier: BSD-3-Clause
// Loop closures of a run from its pose graph file.
#pragma once

#include <array>
#include <istream>
#include <vector>

namespace roomgraph {

/// Two key poses that a loop closure ties.
struct ClosedLoop {
  double t_a = 0, t_b = 0;  ///< s since the start that was named
  std::array<double, 2> a{}, b{};
};

/// Edges of graph.g2o between two key poses (vertices with a stamp) that do not follow each other. Lines that
/// are none of the format are stepped over. Times count from `start_t`.
std::vector<ClosedLoop> readClosures(std::istream& graph, double start_t);

}  // namespace roomgraph
