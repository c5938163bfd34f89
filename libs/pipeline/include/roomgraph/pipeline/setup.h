// SPDX-License-Identifier: BSD-3-Clause
// From a configuration to everything that a run starts with.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "roomgraph/core/config.h"
#include "roomgraph/core/config_schema.h"
#include "roomgraph/observations/object_database.h"
#include "roomgraph/pipeline/options.h"
#include "roomgraph/pipeline/stages.h"

namespace roomgraph {

/// What a run starts with.
struct Setup {
  Options options;
  ObjectDatabase database;
  Stages stages;
  /// INI text of every parameter as it is used, and of the object database, which it expects beside itself as
  /// objects.ini.
  std::string effective_config, objects;
};

/// Registers the classes of every library; safe to call again.
void registerAllClasses();

/// Loads the plug-ins, reads the options, makes the stages and gives them their parameters. `objects_file`: the
/// object database when the config names none. Throws ConfigError (unknown section, key, class, value; object
/// database) or InputError (network file).
std::unique_ptr<Setup> makeSetup(const Config& config, const std::filesystem::path& objects_file);

/// Every section and key that a config may hold, with all registered implementations.
ConfigSchema configSchema();

}  // namespace roomgraph
