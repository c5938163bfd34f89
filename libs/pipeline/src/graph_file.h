// SPDX-License-Identifier: BSD-3-Clause
// Writing of a run's factor graph as a g2o file.
#pragma once

#include <filesystem>

#include "roomgraph/pipeline/semantic_slam.h"

namespace roomgraph {

/// Writes the graph of a finished run with the times of its poses: in the plane when that is asked for and
/// the robot drove on one. Throws RunError when the file cannot be written.
void saveGraph(const SemanticSlam& slam, bool planar_run, const std::filesystem::path& file);

}  // namespace roomgraph
