// SPDX-License-Identifier: BSD-3-Clause
// Files of a run of the engine that MRPT does not write.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "roomgraph/graphslam/engine_run.h"
#include "roomgraph/observations/trajectory.h"

namespace roomgraph {

/// Every file that a run may write, MRPT's and ours; summary.json last.
std::vector<std::string> engineFileNames(const EngineIni& ini);
/// "t tx ty tz qx qy qz qw" lines. Throws RunError.
void writeTrajectory(const std::filesystem::path& file, const std::vector<StampedPose>& world_from_robot);
/// What was run, and how much came of it. Throws RunError.
void writeEngineSummary(const std::filesystem::path& file, const EngineRequest& request, const EngineOutcome& outcome);

}  // namespace roomgraph
