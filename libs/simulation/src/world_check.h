// SPDX-License-Identifier: BSD-3-Clause
// Consistency check of a world description.
#pragma once

#include "roomgraph/simulation/world.h"

namespace roomgraph {

/// Throws ConfigError naming the entry when the world cannot be built: rooms whose walls overlap, doorways
/// beside their wall or into nothing, posters and furniture inside walls, paths through walls or furniture.
void checkWorld(const World& world);

}  // namespace roomgraph
