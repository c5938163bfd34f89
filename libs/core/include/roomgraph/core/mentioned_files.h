// SPDX-License-Identifier: BSD-3-Clause
// Files that configuration values may name.
#pragma once

#include <filesystem>
#include <vector>

#include "roomgraph/core/config.h"

namespace roomgraph {

/// The entries' values, and the items of lists, as file names; of those that end in a format or a rate (net.onnx:yolox@5) also without.
std::vector<std::filesystem::path> mentionedFiles(const Config& config);

}  // namespace roomgraph
