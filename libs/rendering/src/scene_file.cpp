// SPDX-License-Identifier: BSD-3-Clause
// Scene written by MRPT under a temporary name.
#include "roomgraph/rendering/scene_file.h"

#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"
#include "scene.h"

namespace roomgraph {

void saveScene(const CSemanticMap& map, const ObjectDatabase& database, const std::filesystem::path& file) {
  PendingFile pending(file);
  if (!buildScene(map, database)->saveToFile(pending.path().string()))
    throw RunError("cannot write " + file.string());
  pending.commit();
}

}  // namespace roomgraph
