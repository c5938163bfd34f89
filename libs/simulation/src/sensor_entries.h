// SPDX-License-Identifier: BSD-3-Clause
// Sensor entries of a world file.
#pragma once

#include "json_entry.h"
#include "roomgraph/simulation/world.h"

namespace roomgraph {

/// Reads the entry "sensors" into the world. Throws ConfigError for impossible values.
void readSensors(JsonEntry entry, World& world);

}  // namespace roomgraph
