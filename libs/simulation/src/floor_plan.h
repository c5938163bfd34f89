// SPDX-License-Identifier: BSD-3-Clause
// Floor plan of a simulated world: walls, doorways, free areas, building mesh.
#pragma once

#include "roomgraph/simulation/mesh.h"
#include "roomgraph/simulation/world.h"

namespace roomgraph {

/// Axis-aligned rectangle of the plan.
using PlanBox = Eigen::AlignedBox2d;

/// Hole that a doorway cuts through the wall(s).
PlanBox doorwayHole(const World& world, const Room& room, const Doorway& doorway);
/// Frame of a doorway or poster: origin on the inner face of the wall at the floor, x into the room.
Pose3 wallFrame(const Room& room, Side side, double at_m);
/// Free space of the plan: rooms and doorways.
std::vector<PlanBox> freeAreas(const World& world);
/// Is the disc inside the union of the areas?
bool discIsFree(const std::vector<PlanBox>& areas, const Eigen::Vector2d& center, double radius);

/// Floors, ceilings, walls with their doorways, base boards and posters, in the plan's frame.
Mesh buildingMesh(const World& world, MaterialList& materials);

}  // namespace roomgraph
