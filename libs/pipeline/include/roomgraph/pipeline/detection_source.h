// SPDX-License-Identifier: BSD-3-Clause
// Warning before a run that has neither a detector network nor recorded boxes.
#pragma once

#include <filesystem>
#include <string>

#include "roomgraph/pipeline/stages.h"

namespace roomgraph {

/// To be asked before the replay: one line that says what to do when no objects can be mapped because there
/// is neither a network nor, at the beginning of the recording, a recorded box. Empty when all is well, when
/// detection is off or of a class that was named, and when the recording has no images. Throws InputError
/// like RawlogReader.
std::string missingDetections(const Stages& stages, const std::filesystem::path& rawlog);

}  // namespace roomgraph
