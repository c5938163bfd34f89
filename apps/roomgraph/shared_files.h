// SPDX-License-Identifier: BSD-3-Clause
// Lookup of the shipped configuration files beside the program.
#pragma once

#include <filesystem>
#include <string>

namespace roomgraph {

/// config.ini, objects.ini or another shipped file, in ../share/roomgraph as seen from the program; the build folder has links
/// there into the source tree. Symbolic links are resolved. Throws ConfigError naming the place searched.
std::filesystem::path sharedFile(const std::string& name);

/// The catalogue of networks that was asked for; else the shipped one.
std::filesystem::path catalogueFileOf(const std::string& asked_for);

/// The object database that was asked for; else objects.ini beside this file of a run; else the shipped one.
std::filesystem::path objectsFileOf(const std::filesystem::path& run_file, const std::string& asked_for);

}  // namespace roomgraph
