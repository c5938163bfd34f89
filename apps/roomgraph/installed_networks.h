// SPDX-License-Identifier: BSD-3-Clause
// Set-up of a run with the installed networks when nothing else gives boxes.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "configuration.h"
#include "roomgraph/pipeline/setup.h"

namespace roomgraph {

/// Where a run looks for networks when none is named.
struct ModelSource {
  std::string models, catalogue;  ///< empty: the user's model folder, the shipped catalogue
};

/// What a run starts with, and which networks of the model folder it was given.
struct RunSetup {
  std::unique_ptr<Setup> setup;
  std::vector<std::string> networks;  ///< of each role one; empty: none was needed, or none is there
  std::filesystem::path folder;       ///< where they are
};

/// makeSetup(); and when `[detection] class = auto` has neither network nor file, and the beginning of the
/// recording has images and no boxes, again with the best installed networks, or without any the one
/// that comes with the program, as `[detection] models`, which the configuration then names. Whatever comes later in the recording has no say. Throws like makeSetup()
/// and RawlogReader, ConfigError also for a folder or a catalogue that was named and is none.
RunSetup makeRunSetup(Configuration& configuration, const std::filesystem::path& rawlog,
                      const ModelSource& source);

}  // namespace roomgraph
