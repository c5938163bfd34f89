// SPDX-License-Identifier: BSD-3-Clause
// What the steps of the generator of flats share: the world so far, uses of rooms, footprints, random
// choices.
#pragma once

#include <optional>
#include <vector>

#include "floor_plan.h"
#include "roomgraph/core/random.h"
#include "roomgraph/simulation/flat.h"

namespace roomgraph {

enum class RoomUse { kCorridor, kOffice, kLiving, kMeeting, kLounge, kBedroom };

using Polygon = std::vector<Eigen::Vector2d>;  ///< convex, counter-clockwise, m

/// A flat in the making.
struct FlatDraft {
  FlatOptions options;
  World world;
  std::vector<RoomUse> uses;       ///< of world.rooms
  std::vector<double> richness;    ///< of every room's surfaces: 0 bare, 1 full of patterns
  std::vector<Polygon> obstacles;  ///< beside furniture: door leaves, people who stand or sit
};

/// Rounded to `step`, so that world files stay readable.
double inSteps(double value, double step = 0.01);
/// Uniform integer in [low, high].
int drawInt(Random& random, int low, int high);
template <class T>
const T& pick(Random& random, const std::vector<T>& from) {
  return from[static_cast<std::size_t>(drawInt(random, 0, static_cast<int>(from.size()) - 1))];
}
/// low + (high - low) u^power: powers above 1 prefer small values.
double drawSkewed(Random& random, double low, double high, double power);

Polygon boxPolygon(const PlanBox& box);
/// Footprint on the floor: a rectangle, or a polygon of 16 corners for round things.
Polygon floorPolygon(const Furniture& item);
bool touch(const Polygon& a, const Polygon& b);
/// Leaf of an open or half-open door with its handles; nothing for others.
std::optional<Polygon> leafPolygon(const Room& room, const Doorway& doorway);
/// Part of the wall's two sides that a doorway keeps free: its width, `inside` m into its room and `outside` m behind.
PlanBox doorwayZone(const World& world, const Room& room, const Doorway& doorway, double inside, double outside);
/// Does the doorway lead somewhere and can one walk through?
bool passable(const Doorway& doorway);
/// Swivel chairs, sofas and doors.
int objectsThatCount(const World& world);
/// Does checkWorld() accept it?
bool isSound(const World& world);
/// Furniture that is none of these but may be taken for them.
int objectsThatMislead(const World& world);

// The steps, in order; each throws nothing and may leave less than it was asked for.
void planFlat(FlatDraft& draft, int rooms, Random& random);
void decorateFlat(FlatDraft& draft, Random& random);
void furnishFlat(FlatDraft& draft, Random& random);
void seatPeople(FlatDraft& draft, int sitting, int standing, Random& random);
/// False when not every room can be visited.
bool planWay(FlatDraft& draft, Random& random);
/// People who walk, out of the way of robot or camera.
void addWalkers(FlatDraft& draft, int count, Random& random);
void drawSensors(FlatDraft& draft, Random& random);

}  // namespace roomgraph
