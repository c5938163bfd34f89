// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#pragma once

#include <filesystem>
#include <string_view>

namespace roomgraph {

/// Writes a temporary file beside `file` and renames it. Throws RunError naming file and cause.
void writeFileAtomically(const std::filesystem::path& file, std::string_view bytes);

}  // namespace roomgraph
