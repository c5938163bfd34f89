// SPDX-License-Identifier: BSD-3-Clause
// What MRPT's graph-SLAM engine is asked to do, and the function of the module that holds it.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "roomgraph/graphslam/engine_ini.h"
#include "roomgraph/pipeline/setup.h"

namespace roomgraph {

/// A run of the engine over a recording.
struct EngineRequest {
  std::filesystem::path rawlog, ini;
  std::filesystem::path truth;  ///< lines "t x y phi" as MRPT's simulator writes; empty: none
  std::filesystem::path output;
  AskedParts asked;
  /// Called if a part of the engine is ours; once more for objects.
  std::function<std::unique_ptr<Setup>()> make_setup;
  std::function<void(double share)> progress = [](double) {};
  std::function<bool()> interrupted = [] { return false; };
  bool verbose = false;  ///< what the engine and its deciders log goes to the console, too
  bool window = false;
  double exit_after_s = -1;       ///< the window closes so long after the last record; negative: when it is closed
};

/// What came of it.
struct EngineOutcome {
  EngineParts parts;
  int nodes = 0, edges = 0, closures = 0;  ///< closures: edges between nodes more than ten apart
  int records = 0;                         ///< steps of the engine
  double share = 0;                        ///< of the recording, [0, 1]
  bool interrupted = false;
  std::vector<std::string> warnings;  ///< one line each
};

/// Writes the engine's report files, its graph and map, trajectory.tum and, with CObjectClosuresERD, landmarks.json into the output folder. Throws
/// ConfigError (ini), InputError (recording, truth), RunError (no node was registered, output, no display).
using RunEngine = EngineOutcome(const EngineRequest& request);
/// The module with the engine, which brings a GUI library with it, and the name under which it has that function.
inline constexpr const char* kRunEngine = "roomgraph_run_engine";
inline constexpr const char* kEngineModule = "roomgraph_graphslam_engine.so";

}  // namespace roomgraph
