// SPDX-License-Identifier: BSD-3-Clause
// Folder of the public sequences and networks that some tests need.
#pragma once

#include <cstdlib>
#include <filesystem>

namespace roomgraph::test {

/// What the environment variable ROOMGRAPH_DATA names; without it ../shared/data beside the project. It need
/// not exist: tests that miss something in it skip.
inline std::filesystem::path dataFolder() {
  const char* named = std::getenv("ROOMGRAPH_DATA");
  return named ? std::filesystem::path(named) : std::filesystem::path(ROOMGRAPH_SOURCE_DIR) / "../shared/data";
}

}  // namespace roomgraph::test
