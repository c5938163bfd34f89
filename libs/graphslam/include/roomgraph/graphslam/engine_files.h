// SPDX-License-Identifier: BSD-3-Clause
// Files of a run of the engine that MRPT does not write.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "roomgraph/graphslam/engine_run.h"
#include "roomgraph/graphslam/seen_object.h"
#include "roomgraph/observations/trajectory.h"

namespace roomgraph {

/// Every file that a run may write, MRPT's and ours; summary.json last.
std::vector<std::string> engineFileNames(const EngineIni& ini);
/// "t tx ty tz qx qy qz qw" lines. Throws RunError.
void writeTrajectory(const std::filesystem::path& file, const std::vector<StampedPose>& world_from_robot);
/// The objects as `roomgraph evaluate objects` reads them: id, class, x, y, z, yaw, size_wdh, and the number of nodes
/// that see each. Throws RunError.
void writeObjects(const std::filesystem::path& file, const std::map<LandmarkId, PlacedObject>& objects);
/// What was run, and how much came of it. Throws RunError.
void writeEngineSummary(const std::filesystem::path& file, const EngineRequest& request, const EngineOutcome& outcome);

}  // namespace roomgraph
