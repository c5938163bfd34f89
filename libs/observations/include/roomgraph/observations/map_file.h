// SPDX-License-Identifier: BSD-3-Clause
// Reading and writing of map.rgmap.
#pragma once

#include <filesystem>

#include "roomgraph/observations/CSemanticMap.h"

namespace roomgraph {

/// Writes map.rgmap: an MRPT archive and its SHA-256, gzipped. Replaces the file atomically; throws RunError
/// naming file and cause.
void saveMap(const CSemanticMap& map, const std::filesystem::path& file);

/// Reads map.rgmap. Maps of every earlier version load: version 0 had neither checksum nor provenance. Throws
/// InputError naming file and cause.
CSemanticMap loadMap(const std::filesystem::path& file);

}  // namespace roomgraph
