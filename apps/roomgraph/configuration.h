// SPDX-License-Identifier: BSD-3-Clause
// Configuration of a command from --config and --set, with the object database that belongs to it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "roomgraph/core/config.h"

namespace roomgraph {

/// What --config and --set ask for.
struct Configuration {
  std::filesystem::path file;
  Config config;
  std::filesystem::path objects_file;  ///< when the config names none: beside it, else the shipped one
};

/// `file` empty: the shipped config.ini. Throws ConfigError.
Configuration readConfiguration(const std::string& file, const std::vector<std::string>& overrides);

}  // namespace roomgraph
