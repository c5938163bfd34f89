// SPDX-License-Identifier: BSD-3-Clause
// The command line of `roomgraph run`.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "installed_networks.h"
#include "roomgraph/pipeline/replay.h"

namespace roomgraph {

/// What `roomgraph run` is asked for; what was not said is empty.
struct RunOptions {
  std::string input, output, config, map, recording, detections, progress, pictures, resume, calibration;
  std::vector<std::string> overrides, poses;
  ModelSource networks;
  int threads = 0;
  ReplaySpan span;
  std::optional<double> checkpoint_s;
  bool quiet = false, no_snapshot = false, no_report = false;
};

/// Declares all of it, and what --help says.
void declareRunOptions(CLI::App& command, RunOptions& options);

/// What the words of an earlier `roomgraph run` (the program's name and `run` first) asked for, with what is
/// said now besides. Throws InputError when they are not words of that command.
RunOptions withWordsOf(const std::vector<std::string>& words, const RunOptions& now);

}  // namespace roomgraph
