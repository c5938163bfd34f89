// SPDX-License-Identifier: BSD-3-Clause
// The catalogue of networks as a table, as text and as JSON, with what is installed.
#pragma once

#include <filesystem>
#include <string>

#include "roomgraph/models/catalogue.h"

namespace roomgraph {

/// One line per network: size, what it finds, cost and accuracy, where it is installed.
std::string networkTable(const NetworkCatalogue& catalogue, const std::filesystem::path& models);

/// All that is known about one network, in lines.
std::string describeNetwork(const KnownNetwork& network, const std::filesystem::path& models);

/// All of the catalogue, and what is installed.
std::string networksJson(const NetworkCatalogue& catalogue, const std::filesystem::path& models);

}  // namespace roomgraph
