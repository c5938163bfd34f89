// SPDX-License-Identifier: BSD-3-Clause
// Loop closures of a run from its pose graph file.
#pragma once

#include <array>
#include <istream>
#include <string>
#include <vector>

namespace roomgraph {

/// Two key poses that a loop closure ties.
struct ClosedLoop {
  double t_a = 0, t_b = 0;  ///< s since the start that was named
  std::array<double, 2> a{}, b{};
  long id_a = -1, id_b = -1;  ///< vertices of the graph
  std::string kind;  ///< what found it: "tracking", "lidar", "objects"; empty: the file does not tell
  double off_m = 0, off_rad = 0;  ///< between what was measured and where the poses are in the end
  double off_sigmas = 0;          ///< sqrt(eᵀΩe), Ω as in the file; NaN: the file's numbers are no edge
};

/// Edges of graph.g2o between two key poses (vertices with a stamp) that do not follow each other, with what
/// is left of them (the file's errors: docs/formats.md). Lines that are none of the format are stepped over.
/// Times count from `start_t`.
std::vector<ClosedLoop> readClosures(std::istream& graph, double start_t);

}  // namespace roomgraph
