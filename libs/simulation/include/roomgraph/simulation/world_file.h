// SPDX-License-Identifier: BSD-3-Clause
// Reading and writing of world files.
#pragma once

#include <filesystem>
#include <string>

#include "roomgraph/simulation/world.h"

namespace roomgraph {

/// Reads a world file. Throws InputError when it cannot be read, ConfigError (file, entry such as
/// rooms[1].doorways[0].width_m, cause) when it is not JSON, has an unknown key or a value that is not
/// allowed, or when the world cannot be: walls or furniture that overlap walls, paths through walls,
/// furniture without a model.
World readWorld(const std::filesystem::path& file);
/// The same from text; `name` stands for the file in messages.
World parseWorld(const std::string& text, const std::string& name);

/// The world file that describes this world: lengths and angles to six decimals, colours to 8 bits a channel.
std::string worldText(const World& world, const std::string& comment = "");

}  // namespace roomgraph
