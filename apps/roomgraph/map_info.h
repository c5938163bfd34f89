// SPDX-License-Identifier: BSD-3-Clause
// What a map file holds, as text and as JSON.
#pragma once

#include <filesystem>
#include <string>

#include "roomgraph/observations/CSemanticMap.h"

namespace roomgraph {

/// A few lines: grid, objects by class, path, where it comes from.
std::string describeMap(const CSemanticMap& map, const std::filesystem::path& file);
/// The same under stable names, with configuration and object database.
std::string mapInfoJson(const CSemanticMap& map, const std::filesystem::path& file);

}  // namespace roomgraph
