// SPDX-License-Identifier: BSD-3-Clause
// The user's model folder: where it is, which networks are installed in it, and what is wrong with them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "roomgraph/models/catalogue.h"

namespace roomgraph {

/// The folder that was asked for; else roomgraph/models in $XDG_DATA_HOME or in ~/.local/share. Absolute;
/// empty when the environment names neither.
std::filesystem::path modelFolder(const std::string& asked_for);

/// The folder of this network in a model folder.
std::filesystem::path folderOf(const KnownNetwork& network, const std::filesystem::path& models);

/// The file to name as [detection] models.
std::filesystem::path networkFile(const KnownNetwork& network, const std::filesystem::path& models);

/// Whether each file is there in its full size (the bytes are not looked at).
bool isInstalled(const KnownNetwork& network, const std::filesystem::path& models);

/// Whether any of its files is there, or a part of one.
bool isBegun(const KnownNetwork& network, const std::filesystem::path& models);

/// What is wrong with the files, one sentence each; checksums too. Throws InputError when a file cannot be
/// read.
std::vector<std::string> faultsOf(const KnownNetwork& network, const std::filesystem::path& models);

/// Of each role the first network of the catalogue that is installed.
std::vector<KnownNetwork> networksToRun(const NetworkCatalogue& catalogue,
                                        const std::filesystem::path& models);

}  // namespace roomgraph
