// SPDX-License-Identifier: BSD-3-Clause
// Overlaps of rooms and furniture, doorways, posters, and collisions of paths.
#include "world_check.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "floor_plan.h"
#include "models.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/geometry/shape.h"
#include "sensor_path.h"

namespace roomgraph {
namespace {

constexpr double kTolerance_m = 1e-6;

[[noreturn]] void fail(const World& world, const std::string& place, const std::string& what) {
  throw ConfigError(world.file + ": " + place + ": " + what);
}

std::string text(const Eigen::Vector2d& p) {
  std::ostringstream out;
  out.precision(3);
  out << "(" << p.x() << ", " << p.y() << ")";
  return out.str();
}

void checkWalls(const World& world) {
  for (std::size_t i = 0; i < world.rooms.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const PlanBox a(world.rooms[i].min_m, world.rooms[i].max_m),
          b(world.rooms[k].min_m, world.rooms[k].max_m);
      // Rooms share a wall when they are exactly its thickness apart; then each may be as thick as it.
      const Eigen::Vector2d gap = (a.min() - b.max()).cwiseMax(b.min() - a.max());
      if (gap.maxCoeff() < world.wall_thickness_m - kTolerance_m)
        fail(world, world.rooms[i].place,
             "overlaps " + world.rooms[k].place +
                 " or its walls: rooms must be at least wall_thickness_m apart");
    }
  }
}

void checkDoorway(const World& world, const Room& room, const Doorway& doorway) {
  const bool along_x = doorway.side == Side::kNorth || doorway.side == Side::kSouth;
  const double low = along_x ? room.min_m.x() : room.min_m.y(),
               high = along_x ? room.max_m.x() : room.max_m.y();
  if (doorway.at_m - doorway.width_m / 2 < low - kTolerance_m ||
      doorway.at_m + doorway.width_m / 2 > high + kTolerance_m)
    fail(world, doorway.place + ".at_m", "the doorway does not fit into its wall");
  if (doorway.door == DoorState::kClosed) return;
  const PlanBox hole = doorwayHole(world, room, doorway);
  for (const auto& other : world.rooms) {
    if (&other == &room) continue;
    PlanBox inner(other.min_m, other.max_m);
    inner.min().array() -= kTolerance_m;
    inner.max().array() += kTolerance_m;
    const PlanBox shared = inner.intersection(hole);
    const double extent = along_x ? shared.sizes().x() : shared.sizes().y();
    if (!shared.isEmpty() && extent > doorway.width_m - 1e-3) return;
  }
  fail(world, doorway.place,
       "leads into nothing: there is no room exactly wall_thickness_m away; close it by a door");
}

/// Footprint rectangle of furniture in the plan.
std::vector<Eigen::Vector2d> footprintOf(const Furniture& item, double grow = 0) {
  const Eigen::Vector3d size = item.size_m.value_or(furnitureModel(item.model).size_m);
  std::vector<Eigen::Vector2d> out;
  const Pose2 pose{item.at_m.x(), item.at_m.y(), item.yaw_rad};
  for (const auto& [x, y] : {std::pair{1, 1}, {-1, 1}, {-1, -1}, {1, -1}})
    out.push_back(pose * Eigen::Vector2d(x * (size.y() / 2 + grow), y * (size.x() / 2 + grow)));
  return out;
}

/// The item at each of its places, one after the other.
std::vector<Furniture> placesOf(const Furniture& item) {
  std::vector<Furniture> out{item};
  for (std::size_t i = 0; i < item.moves.size(); ++i) {
    out.push_back(item);
    out.back().at_m = item.moves[i].at_m;
    out.back().yaw_rad = item.moves[i].yaw_rad;
    out.back().place += ".moves[" + std::to_string(i) + "]";
  }
  return out;
}

std::vector<Furniture> allPlaces(const World& world) {
  std::vector<Furniture> out;
  for (const auto& item : world.furniture)
    for (auto& place : placesOf(item)) out.push_back(std::move(place));
  return out;
}

std::vector<Furniture> placesAt(const World& world, double seconds) {
  std::vector<Furniture> out;
  for (const auto& item : world.furniture) {
    const auto later = std::find_if(item.moves.begin(), item.moves.end(), [&](const auto& move) { return move.at_s > seconds; });
    out.push_back(placesOf(item)[static_cast<std::size_t>(later - item.moves.begin())]);
  }
  return out;
}

/// When the furniture stands otherwise: the beginning, and the instants of moves.
std::set<double> arrangementsOf(const World& world) {
  std::set<double> out{0};
  for (const auto& item : world.furniture)
    for (const auto& move : item.moves) out.insert(move.at_s);
  return out;
}

void checkFurniture(const World& world, const std::vector<PlanBox>& areas) {
  for (const auto& item : allPlaces(world)) {
    for (const auto& corner : footprintOf(item, -0.005))
      if (!discIsFree(areas, corner, 0))
        fail(world, item.place, "the " + item.model + " stands in a wall at " + text(corner));
    const double height = item.size_m.value_or(furnitureModel(item.model).size_m).z();
    if (item.at_m.z() + height > world.wall_height_m + kTolerance_m)
      fail(world, item.place, "the " + item.model + " is higher than the room");
  }
}

bool inside(const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& p) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d a = polygon[i], d = polygon[(i + 1) % polygon.size()] - a, q = p - a;
    if (d.x() * q.y() - d.y() * q.x() < 0) return false;
  }
  return true;
}

void checkPoint(const World& world, const std::vector<PlanBox>& areas, const std::vector<Furniture>& furniture,
                const std::string& place, const Eigen::Vector2d& at, double radius) {
  if (!discIsFree(areas, at, radius)) fail(world, place, "the path goes through a wall at " + text(at));
  for (const auto& item : furniture)
    if (item.at_m.z() < 1.5 && inside(footprintOf(item, radius), at))
      fail(world, place, "the path goes through " + item.place + " (" + item.model + ") at " + text(at));
}

void checkDoorsOnPath(const World& world, const std::string& place, const Eigen::Vector2d& at) {
  for (const auto& room : world.rooms)
    for (const auto& doorway : room.doorways)
      if (doorway.door == DoorState::kClosed && doorwayHole(world, room, doorway).contains(at))
        fail(world, place, "the path goes through a closed door, " + doorway.place);
}

void checkRobotPath(const World& world, const std::vector<PlanBox>& areas) {
  const SensorPath path(*world.robot);
  const std::string place = world.robot->place + ".path_m";
  const std::set<double> arrangements = arrangementsOf(world);
  for (auto from = arrangements.begin(); from != arrangements.end(); ++from) {
    const std::vector<Furniture> furniture = placesAt(world, *from);
    const auto next = std::next(from);
    const double until = next == arrangements.end() ? path.duration() : std::min(*next, path.duration());
    // What is moved later must leave the robot where it rests.
    for (double t = std::min(*from, path.duration()); t <= until; t += 0.05) {
      const Eigen::Vector2d at = path.at(t).translation().head<2>();
      checkPoint(world, areas, furniture, place, at, world.robot->radius_m);
      checkDoorsOnPath(world, place, at);
    }
  }
}

void checkPaths(const World& world, const std::vector<PlanBox>& areas) {
  if (world.robot) checkRobotPath(world, areas);
  if (world.handheld) {
    const SensorPath path(*world.handheld);
    for (double t = 0; t <= path.duration(); t += 0.05) {
      const Eigen::Vector3d at = path.at(t).translation();
      if (!discIsFree(areas, at.head<2>(), 0.1) || at.z() < 0.1 || at.z() > world.wall_height_m - 0.1)
        fail(world, world.handheld->place + ".views",
             "the path goes through a wall at " + text(at.head<2>()));
    }
  }
  const std::vector<Furniture> everywhere = allPlaces(world);  // people do not wait for it to be moved
  for (const auto& person : world.people) {
    for (std::size_t i = 0; i < person.path_m.size(); ++i) {
      const Eigen::Vector2d a = person.path_m[i],
                            b = person.path_m[std::min(i + 1, person.path_m.size() - 1)];
      const int steps = 1 + static_cast<int>((b - a).norm() / 0.05);
      for (int k = 0; k <= steps; ++k) {
        const Eigen::Vector2d at = a + (b - a) * k / steps;
        if (person.path_m.size() > 1) checkPoint(world, areas, everywhere, person.place + ".path_m", at, 0.15);
        if (!discIsFree(areas, at, 0.15))
          fail(world, person.place + ".path_m", "stands in a wall at " + text(at));
        checkDoorsOnPath(world, person.place + ".path_m", at);
      }
    }
  }
}

void checkPosters(const World& world) {
  for (const auto& room : world.rooms) {
    for (std::size_t i = 0; i < room.posters.size(); ++i) {
      const auto& poster = room.posters[i];
      const bool along_x = poster.side == Side::kNorth || poster.side == Side::kSouth;
      const double low = along_x ? room.min_m.x() : room.min_m.y(),
                   high = along_x ? room.max_m.x() : room.max_m.y();
      if (poster.at_m - poster.width_m / 2 < low || poster.at_m + poster.width_m / 2 > high ||
          poster.z_m - poster.height_m / 2 < 0 || poster.z_m + poster.height_m / 2 > world.wall_height_m)
        fail(world, room.place + ".posters[" + std::to_string(i) + "]", "does not fit on its wall");
    }
  }
}

}  // namespace

void checkWorld(const World& world) {
  checkWalls(world);
  for (const auto& room : world.rooms)
    for (const auto& doorway : room.doorways) checkDoorway(world, room, doorway);
  checkPosters(world);
  const auto areas = freeAreas(world);
  checkFurniture(world, areas);
  checkPaths(world, areas);
}

}  // namespace roomgraph
