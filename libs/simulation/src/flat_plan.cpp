// SPDX-License-Identifier: BSD-3-Clause
// Floor plan of a random flat: rooms along a corridor, doorways between neighbours, closed doors.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "flat_draft.h"

namespace roomgraph {
namespace {

/// Boxes of one row of rooms side by side; y grows away from the corridor, which ends at y = 0.
std::vector<PlanBox> roomRow(int count, double wall, Random& random) {
  std::vector<PlanBox> out;
  double x = 0;
  for (int i = 0; i < count; ++i) {
    const double w = inSteps(random.uniform(3.2, 5.2)), d = inSteps(random.uniform(3.2, 5.0));
    out.emplace_back(Eigen::Vector2d(x, 0), Eigen::Vector2d(x + w, d));
    x += w + wall;
  }
  return out;
}

double endOf(const std::vector<PlanBox>& row) {
  return row.empty() ? 0 : row.back().max().x();
}

/// The corridor first, rooms on both of its long sides, and perhaps one at its end.
std::vector<PlanBox> corridorPlan(int rooms, double wall, Random& random) {
  const double wide = inSteps(random.uniform(1.4, 2.0));
  const int at_end = rooms >= 4 && random.chance(0.5) ? 1 : 0, others = rooms - at_end;
  const int above = others - (random.chance(0.75) ? others / 2 : std::min(1, others / 2));
  const auto north = roomRow(above, wall, random), south = roomRow(others - above, wall, random);
  const double length = std::max(endOf(north), endOf(south));
  std::vector<PlanBox> out{PlanBox(Eigen::Vector2d(0, 0), Eigen::Vector2d(length, wide))};
  for (const auto& box : north) out.push_back(box.translated(Eigen::Vector2d(0, wide + wall)));
  for (const auto& box : south)
    out.emplace_back(Eigen::Vector2d(box.min().x(), -wall - box.max().y()), Eigen::Vector2d(box.max().x(), -wall));
  if (at_end) {
    const double w = inSteps(random.uniform(3.2, 5.0)), d = inSteps(random.uniform(3.2, 5.0));
    const double low = inSteps(wide / 2 - d / 2);
    out.emplace_back(Eigen::Vector2d(length + wall, low), Eigen::Vector2d(length + wall + w, low + d));
  }
  return out;
}

std::vector<PlanBox> boxesOf(int rooms, double wall, Random& random) {
  if (rooms >= 3) return corridorPlan(rooms, wall, random);
  if (rooms == 2) {
    auto out = roomRow(2, wall, random);
    for (auto& box : out) box.max() += Eigen::Vector2d(0, 0.4);
    return out;
  }
  return {PlanBox(Eigen::Vector2d(0, 0), Eigen::Vector2d(inSteps(random.uniform(5.5, 8)), inSteps(random.uniform(4.8, 6.5))))};
}

/// Stretch of wall that two rooms share, as seen from the first; its length is 0 when there is none.
struct SharedWall {
  Side side = Side::kNorth;
  double low = 0, high = 0;
};

SharedWall sharedWall(const Room& a, const Room& b, double wall) {
  const auto beside = [&](double high_a, double low_b) { return std::abs(low_b - high_a - wall) < 1e-6; };
  SharedWall out;
  const bool x = beside(a.max_m.x(), b.min_m.x()) || beside(b.max_m.x(), a.min_m.x()),
             y = beside(a.max_m.y(), b.min_m.y()) || beside(b.max_m.y(), a.min_m.y());
  if (x == y) return out;
  const int along = x ? 1 : 0;
  out.side = x ? (b.min_m.x() > a.max_m.x() ? Side::kEast : Side::kWest)
               : (b.min_m.y() > a.max_m.y() ? Side::kNorth : Side::kSouth);
  out.low = std::max(a.min_m[along], b.min_m[along]);
  out.high = std::max(out.low, std::min(a.max_m[along], b.max_m[along]));
  return out;
}

double doorHeight(Random& random) {
  return inSteps(random.uniform(1.95, 2.11));
}

std::array<double, 3> doorColor(Random& random) {
  return pick<std::array<double, 3>>(random, {{0.55, 0.38, 0.22}, {0.82, 0.8, 0.75}, {0.42, 0.28, 0.17}, {0.7, 0.56, 0.38}, {0.5, 0.53, 0.56}});
}

/// No other doorway's hole is near.
bool holeIsAlone(const World& world, const PlanBox& hole) {
  for (const auto& room : world.rooms)
    for (const auto& doorway : room.doorways)
      if (doorwayHole(world, room, doorway).exteriorDistance(hole.center()) < 0.3 + hole.sizes().maxCoeff() / 2)
        return false;
  return true;
}

/// A doorway from room `a` into `b`, if they have enough wall in common.
bool connect(World& world, std::size_t a, std::size_t b, Random& random) {
  const SharedWall wall = sharedWall(world.rooms[a], world.rooms[b], world.wall_thickness_m);
  const double margin = 0.3;
  for (int attempt = 0; attempt < 20; ++attempt) {
    Doorway doorway;
    doorway.side = wall.side;
    doorway.width_m = inSteps(random.uniform(0.88, 1.06));
    doorway.height_m = doorHeight(random);
    doorway.color = doorColor(random);
    const double low = wall.low + doorway.width_m / 2 + margin, high = wall.high - doorway.width_m / 2 - margin;
    if (low > high) return false;
    doorway.at_m = inSteps(random.uniform(low, high));
    const double state = random.uniform();
    doorway.door = state < 0.25 ? DoorState::kNone : state < 0.42 ? DoorState::kHalfOpen : DoorState::kOpen;
    if (doorway.door == DoorState::kHalfOpen) doorway.width_m = std::max(doorway.width_m, 1.04);
    if (!holeIsAlone(world, doorwayHole(world, world.rooms[a], doorway))) continue;
    world.rooms[a].doorways.push_back(doorway);
    return true;
  }
  return false;
}

/// A closed door, out of the flat or into a neighbour's room.
void addClosedDoor(World& world, Random& random) {
  for (int attempt = 0; attempt < 30; ++attempt) {
    Room& room = world.rooms[static_cast<std::size_t>(drawInt(random, 0, static_cast<int>(world.rooms.size()) - 1))];
    Doorway doorway;
    doorway.side = static_cast<Side>(drawInt(random, 0, 3));
    doorway.width_m = drawSkewed(random, 0.7, 0.9, 1.4);
    doorway.height_m = doorHeight(random);
    doorway.color = doorColor(random);
    doorway.door = DoorState::kClosed;
    const int along = doorway.side == Side::kNorth || doorway.side == Side::kSouth ? 0 : 1;
    const double low = room.min_m[along] + doorway.width_m / 2 + 0.15, high = room.max_m[along] - doorway.width_m / 2 - 0.15;
    if (low > high) continue;
    doorway.at_m = inSteps(random.uniform(low, high));
    const PlanBox hole = doorwayHole(world, room, doorway);
    if (!holeIsAlone(world, hole)) continue;
    // The wall behind it is all of one neighbour or of nobody.
    bool whole = true;
    for (const auto& other : world.rooms) {
      if (&other == &room) continue;
      const PlanBox shared = PlanBox(other.min_m.array() - 0.01, other.max_m.array() + 0.01).intersection(hole);
      if (!shared.isEmpty() && shared.sizes()[along] < doorway.width_m - 1e-3) whole = false;
    }
    if (!whole) continue;
    room.doorways.push_back(doorway);
    return;
  }
}

RoomUse drawUse(int rooms, Random& random) {
  const double u = random.uniform();
  if (rooms == 1) return u < 0.6 ? RoomUse::kOffice : u < 0.8 ? RoomUse::kMeeting : RoomUse::kLounge;
  return u < 0.36   ? RoomUse::kOffice
         : u < 0.58 ? RoomUse::kLiving
         : u < 0.76 ? RoomUse::kMeeting
         : u < 0.9  ? RoomUse::kLounge
                    : RoomUse::kBedroom;
}

}  // namespace

void planFlat(FlatDraft& draft, int rooms, Random& random) {
  World& world = draft.world;
  world.wall_thickness_m = inSteps(random.uniform(0.08, 0.2));
  world.wall_height_m = inSteps(random.uniform(2.4, 2.8));
  const bool swapped = random.chance(0.5);
  for (const auto& box : boxesOf(rooms, world.wall_thickness_m, random)) {
    Room room;
    room.min_m = swapped ? Eigen::Vector2d(box.min().y(), box.min().x()) : box.min();
    room.max_m = swapped ? Eigen::Vector2d(box.max().y(), box.max().x()) : box.max();
    const bool corridor = rooms >= 3 && world.rooms.empty();
    room.name = corridor ? "corridor" : "room_" + std::to_string(world.rooms.size() + (rooms >= 3 ? 0 : 1));
    draft.uses.push_back(corridor ? RoomUse::kCorridor : drawUse(rooms, random));
    world.rooms.push_back(room);
  }
  for (std::size_t i = 1; i < world.rooms.size(); ++i) {
    connect(world, i, 0, random);
    for (std::size_t k = 1; k < i; ++k)
      if (random.chance(0.3)) connect(world, i, k, random);
  }
  const int closed = drawInt(random, rooms == 1 ? 2 : 1, 1 + rooms);
  for (int i = 0; i < closed; ++i) addClosedDoor(world, random);
}

}  // namespace roomgraph
