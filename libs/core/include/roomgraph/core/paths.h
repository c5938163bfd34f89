// SPDX-License-Identifier: BSD-3-Clause
// Whether a path lies inside a folder, symbolic links resolved.
#pragma once

#include <filesystem>

namespace roomgraph {

/// Whether `file` is the folder or lies in it, links followed as far as they exist; an empty path lies
/// nowhere.
bool isInside(const std::filesystem::path& file, const std::filesystem::path& folder);

}  // namespace roomgraph
