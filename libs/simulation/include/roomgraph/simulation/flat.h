// SPDX-License-Identifier: BSD-3-Clause
// Random flats: worlds drawn from a seed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "roomgraph/simulation/world.h"

namespace roomgraph {

struct FlatOptions {
  std::uint64_t seed = 1;
  int rooms = 0;          ///< 1 to 5 without corridors; 0: drawn
  bool handheld = false;  ///< a camera carried by hand in place of a robot
  /// Folder of catalogue models (see worlds/extract_meshes.sh) that take the place of some built shapes; empty, or
  /// files that are not there: built shapes only.
  std::filesystem::path meshes;
};

/// World file of a flat with rooms, furniture of drawn shapes and sizes, things that mislead a detector, people, a way
/// through all rooms, and sensors with drawn properties. The same options give the same text. Throws ConfigError when
/// the number of rooms is not within 0 to 5.
std::string flatText(const FlatOptions& options);

/// The world of flatText().
World randomFlat(const FlatOptions& options);

}  // namespace roomgraph
