// SPDX-License-Identifier: BSD-3-Clause
// Truth named in a job file.
#pragma once

#include "roomgraph/batch/plan.h"

namespace roomgraph {

/// The simulator's files in a folder.
TruthFiles truthInFolder(const std::filesystem::path& folder);

/// What an entry names for one recording. Throws InputError: not there.
TruthFiles namedTruth(const InputEntry& entry, const std::filesystem::path& rawlog);

/// File name without .rawlog and .gz.
std::string recordingName(const std::filesystem::path& rawlog);

}  // namespace roomgraph
