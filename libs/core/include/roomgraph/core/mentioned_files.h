// SPDX-License-Identifier: BSD-3-Clause
// Files that configuration values may name.
#pragma once

#include <filesystem>
#include <vector>

#include "roomgraph/core/config.h"

namespace roomgraph {

/// Whatever the entries' values, or the items of lists, would name if they were files.
std::vector<std::filesystem::path> mentionedFiles(const Config& config);

}  // namespace roomgraph
