// SPDX-License-Identifier: BSD-3-Clause
// Text summaries of a run: progress, objects per class, counts and timing.
#pragma once

#include <string>
#include <vector>

#include "roomgraph/datasets/rawlog_reader.h"
#include "roomgraph/pipeline/replay.h"

namespace roomgraph {

/// Progress of a replay in words: how much, how fast.
std::string describeProgress(const ReplayState& state, double elapsed_s);

/// "3 objects: 2 swivel_chair, 1 sofa".
std::string describeObjects(const std::vector<Landmark>& landmarks);

/// What was found and how long it took, in lines.
std::string describeRun(const SlamResult& result, const ReplayState& replayed, const ReadStatistics& read,
                        double elapsed_s);

/// Draws snapshot.png; a run without a picture is a run all the same: then false, with a warning. Throws
/// RunError: a full disk.
bool drawSnapshot(const CSemanticMap& map, const ObjectDatabase& database, const std::filesystem::path& png);

}  // namespace roomgraph
