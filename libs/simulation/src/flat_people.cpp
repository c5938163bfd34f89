// SPDX-License-Identifier: BSD-3-Clause
// People of a random flat: who sits, who stands, who walks.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "flat_grid.h"
#include "person_model.h"
#include "sensor_path.h"
#include "sitting.h"

namespace roomgraph {
namespace {

Person drawPerson(Random& random) {
  using Paint = std::array<double, 3>;
  const auto cloth = [&] { return Paint{random.uniform(0.08, 0.85), random.uniform(0.08, 0.8), random.uniform(0.1, 0.8)}; };
  Person out;
  out.height_m = inSteps(random.uniform(1.55, 1.92));
  out.shirt = cloth();
  out.trousers = {random.uniform(0.05, 0.4), random.uniform(0.05, 0.38), random.uniform(0.08, 0.45)};
  out.skin = pick(random, skinColors());
  out.hair = pick(random, hairColors());
  return out;
}

/// Floor in front of a seat: knees and feet of somebody who sits there.
Polygon feetPolygon(const Pose2& seat) {
  Polygon out;
  for (const auto& corner : {Eigen::Vector2d(0, -0.25), Eigen::Vector2d(0.62, -0.25), Eigen::Vector2d(0.62, 0.25), Eigen::Vector2d(0, 0.25)})
    out.push_back(seat * corner);
  return out;
}

/// A person on a chair, stool or sofa whose feet have room (below a table is room, too).
bool seatOne(FlatDraft& draft, Random& random) {
  const auto& furniture = draft.world.furniture;
  const std::size_t index = static_cast<std::size_t>(drawInt(random, 0, static_cast<int>(furniture.size()) - 1));
  const Furniture& seat = furniture[index];
  const auto height = seatHeight(seat);
  if (!height) return false;
  const Eigen::Vector3d size = *seat.size_m;
  if (seat.model == "stool" && size.z() > 0.6) return false;
  const double along = seat.model == "sofa" ? random.uniform(-0.5, 0.5) * std::max(0.0, size.x() - 1.1) : 0;
  const Pose2 at = placeOnSeat(seat, along);
  const Polygon feet = feetPolygon(at);
  for (std::size_t i = 0; i < furniture.size(); ++i) {
    const bool below = furniture[i].model == "desk" || (furniture[i].model == "table" && furniture[i].size_m->z() > 0.6);
    if (i != index && !below && furniture[i].at_m.z() < 0.3 && touch(feet, floorPolygon(furniture[i]))) return false;
  }
  for (const auto& other : draft.obstacles)
    if (touch(feet, other)) return false;
  for (const auto& corner : feet)
    if (!discIsFree(freeAreas(draft.world), corner, 0.02)) return false;
  Person person = drawPerson(random);
  person.sits = true;
  person.path_m = {Eigen::Vector2d(inSteps(at.x, 0.001), inSteps(at.y, 0.001))};
  person.yaw_rad = at.yaw;
  person.seat_height_m = inSteps(*height);
  draft.world.people.push_back(person);
  draft.obstacles.push_back(feet);
  return true;
}

bool standOne(FlatDraft& draft, const FloorGrid& grid, Random& random) {
  const Room& room = draft.world.rooms[static_cast<std::size_t>(drawInt(random, 0, static_cast<int>(draft.world.rooms.size()) - 1))];
  const Eigen::Vector2d at(inSteps(random.uniform(room.min_m.x() + 0.4, room.max_m.x() - 0.4)),
                           inSteps(random.uniform(room.min_m.y() + 0.4, room.max_m.y() - 0.4)));
  // Beside the way rather than on it.
  if (grid.clearance(at) < 0.3 || grid.clearance(at) > 0.6) return false;
  for (const auto& other : draft.world.rooms)
    for (const auto& doorway : other.doorways)
      if (doorwayZone(draft.world, other, doorway, 0.8, 0.8).exteriorDistance(at) < 0.3) return false;
  Person person = drawPerson(random);
  person.path_m = {at};
  person.yaw_rad = inSteps(random.uniform(-std::numbers::pi, std::numbers::pi));
  draft.world.people.push_back(person);
  draft.obstacles.push_back(boxPolygon(PlanBox(at.array() - 0.28, at.array() + 0.28)));
  return true;
}

/// Does a walking person come nearer than this to the sensor?
bool meets(const Person& person, const SensorPath& path, double distance_m) {
  const PersonWalk walk(person);
  for (double t = 0; t <= path.duration(); t += 0.1) {
    const Pose2 at = walk.at(t).pose;
    if ((path.at(t).translation().head<2>() - Eigen::Vector2d(at.x, at.y)).norm() < distance_m) return true;
  }
  return false;
}

/// Every third of a metre of a way, and its end.
std::vector<Eigen::Vector2d> thinned(const std::vector<Eigen::Vector2d>& way) {
  std::vector<Eigen::Vector2d> out{way.front()};
  for (const auto& point : way)
    if ((point - out.back()).norm() > 0.33) out.emplace_back(inSteps(point.x(), 0.001), inSteps(point.y(), 0.001));
  return out;
}

}  // namespace

void seatPeople(FlatDraft& draft, int sitting, int standing, Random& random) {
  for (int attempt = 0; attempt < 40 && sitting > 0; ++attempt) sitting -= seatOne(draft, random);
  const FloorGrid grid = floorGridOf(draft);
  for (int attempt = 0; attempt < 60 && standing > 0; ++attempt) standing -= standOne(draft, grid, random);
}

void addWalkers(FlatDraft& draft, int count, Random& random) {
  constexpr double kRoom_m = 0.25, kApart_m = 0.5;
  const FloorGrid grid = floorGridOf(draft);
  const SensorPath path = draft.world.robot ? SensorPath(*draft.world.robot) : SensorPath(*draft.world.handheld);
  const auto cells = grid.reachable(path.at(0).translation().head<2>(), kRoom_m);
  if (cells.empty()) return;
  for (int attempt = 0; attempt < 150 && count > 0; ++attempt) {
    const Eigen::Vector2d from = pick(random, cells), to = pick(random, cells);
    if ((to - from).norm() < 1 || (to - from).norm() > 5) continue;
    const auto way = grid.way(from, to, kRoom_m);
    if (way.empty()) continue;
    Person person = drawPerson(random);
    person.path_m = thinned(way);
    person.speed_m_s = inSteps(random.uniform(0.4, 1.1));
    person.start_s = inSteps(random.uniform(0, 20), 0.1);
    if (meets(person, path, kApart_m)) continue;
    draft.world.people.push_back(person);
    --count;
  }
}

}  // namespace roomgraph
