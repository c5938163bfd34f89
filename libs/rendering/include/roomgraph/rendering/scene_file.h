// SPDX-License-Identifier: BSD-3-Clause
// The map as a file of a 3D scene.
#pragma once

#include <filesystem>

#include "roomgraph/observations/CSemanticMap.h"
#include "roomgraph/observations/object_database.h"

namespace roomgraph {

/// Writes the scene of the pictures as .3Dscene, which MRPT's SceneViewer3D opens; world, m. Needs no
/// display. Throws RunError naming file and cause.
void saveScene(const CSemanticMap& map, const ObjectDatabase& database, const std::filesystem::path& file);

}  // namespace roomgraph
