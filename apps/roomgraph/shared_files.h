// SPDX-License-Identifier: BSD-3-Clause
// Lookup of the shipped configuration files, installed or in the source tree.
#pragma once

#include <filesystem>
#include <string>

namespace roomgraph {

/// config.ini or objects.ini as shipped: beside the installed program (share/roomgraph), or in the source
/// tree when run from the build folder. Throws ConfigError naming the places searched.
std::filesystem::path sharedFile(const std::string& name);

/// The catalogue of networks that was asked for; else the shipped one.
std::filesystem::path catalogueFileOf(const std::string& asked_for);

/// The object database that was asked for; else objects.ini beside this file of a run; else the shipped one.
std::filesystem::path objectsFileOf(const std::filesystem::path& run_file, const std::string& asked_for);

}  // namespace roomgraph
