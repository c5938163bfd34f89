// SPDX-License-Identifier: BSD-3-Clause
// Groups of furniture as people arrange them: desks with chairs, seats around tables, rows at walls.
#pragma once

#include <string>
#include <vector>

#include "flat_draft.h"

namespace roomgraph {

/// Furniture in the group's own frame. At a wall: origin on the wall, x into the room, y along it; otherwise the origin
/// is the group's middle. Pieces of one group may only touch where a seat stands partly under a table.
struct FurnitureGroup {
  std::vector<Furniture> items;
  bool at_wall = true;
  bool fills_corner = false;  ///< prefers the end of a wall
};

/// A single piece of drawn size, shape and colour at the origin, its front to +x.
Furniture drawFurniture(const std::string& model, Random& random);
/// One piece at a wall, its back to it.
FurnitureGroup atWall(const Furniture& item, double gap_m = 0.03);
/// One piece anywhere.
FurnitureGroup standsAlone(Furniture item);

FurnitureGroup deskGroup(Random& random);
FurnitureGroup deskBlock(Random& random);
FurnitureGroup sofaGroup(Random& random);
FurnitureGroup diningGroup(bool meeting, Random& random);
FurnitureGroup caseRow(Random& random);
FurnitureGroup chairRow(Random& random);
FurnitureGroup backToBack(Random& random);
FurnitureGroup whiteboardOnWall(Random& random);

/// What a room of this use and area (m^2) holds, the most important first.
std::vector<FurnitureGroup> groupsFor(RoomUse use, double area_m2, Random& random);

}  // namespace roomgraph
