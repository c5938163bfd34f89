// SPDX-License-Identifier: BSD-3-Clause
// What the ini of MRPT's graphslam-engine says about the run as a whole.
#pragma once

#include <filesystem>
#include <string>

#include "roomgraph/graphslam/decider_names.h"

namespace roomgraph {

/// Section [GeneralConfiguration], with the keys and defaults of graphslam-engine, and ours: the parts of the
/// engine. The other sections are read by the engine and its deciders.
struct EngineIni {
  EngineParts parts{"CFixedIntervalsNRD", {"CICPCriteriaERD"}, "CLevMarqGSO", 2};
  bool save_graph = true, save_scene = true, save_map = true;
  std::string graph_file = "output_graph.graph", scene_file = "scene.3DScene", map_file = "output_map";
};

/// Names given besides the ini; what is empty or 0 is as in the ini.
struct AskedParts {
  std::string node, edges, optimizer;
  int dimensions = 0;
};

/// Throws ConfigError naming file, key and value: no such file, not the text of an ini, a part that there is
/// none, a name of an output file with a folder in it.
EngineIni readEngineIni(const std::filesystem::path& file, const AskedParts& asked);

}  // namespace roomgraph
