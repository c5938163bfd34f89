// SPDX-License-Identifier: BSD-3-Clause
// Evidence for a calibration from a rawlog: odometries run, walls and planes found.
#pragma once

#include <filesystem>
#include <functional>

#include "evidence.h"
#include "roomgraph/calibration/calibrate.h"

namespace roomgraph {

/// Reads a recording once. `sensors` says what former recordings had and is completed. Throws as calibrate()
/// does.
RecordingEvidence readEvidence(const std::filesystem::path& recording, const ReadOptions& read,
                               const std::optional<Board>& board, SensorsBefore& sensors,
                               const std::function<void(double)>& progress);

}  // namespace roomgraph
