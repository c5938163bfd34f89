// SPDX-License-Identifier: BSD-3-Clause
// Simulation of a recording with ground truth from a world and a seed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "roomgraph/simulation/world.h"

namespace roomgraph {

struct SimulateOptions {
  std::uint64_t seed = 1;
  std::string world_text;  ///< written as world.json beside the recording; empty: no such file
  /// Called after every record group with simulated seconds done and in all; may be empty.
  std::function<void(double, double)> progress;
  /// True: stop; what was simulated so far becomes a complete recording. May be empty.
  std::function<bool()> interrupted;
};

struct SimulateResult {
  std::filesystem::path rawlog;
  int frames = 0, scans = 0, odometry = 0, detections = 0, objects = 0;
  double seconds = 0;  ///< simulated
  bool interrupted = false;
};

/// Drives through the world and writes NAME.rawlog (gzip) and the truth files into `folder`, which is made.
/// The same world and seed give the same bytes. Throws RunError when something cannot be written or rendered,
/// ConfigError when the world file would be replaced.
SimulateResult simulate(const World& world, const std::filesystem::path& folder,
                        const SimulateOptions& options);

}  // namespace roomgraph
