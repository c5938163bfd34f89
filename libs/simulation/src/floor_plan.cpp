// SPDX-License-Identifier: BSD-3-Clause
// Walls with openings, base boards and posters; free space of rooms and doorways.
#include "floor_plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "furniture_builders.h"

namespace roomgraph {
namespace {

using V = Eigen::Vector3d;

struct Opening {
  double from = 0, to = 0, height = 0;  ///< in the wall's own frame, y to the left as seen from inside
  bool own = false;
};

bool alongX(Side side) {
  return side == Side::kNorth || side == Side::kSouth;
}

/// Openings of one wall, by its own doorways or by those of the room behind it, sorted.
std::vector<Opening> openingsOf(const World& world, const Room& room, Side side, const Pose3& room_wall) {
  std::vector<Opening> out;
  for (const auto& other : world.rooms) {
    for (const auto& doorway : other.doorways) {
      const bool own = &other == &room;
      if (own && doorway.side != side) continue;
      const PlanBox hole = doorwayHole(world, other, doorway);
      const Pose3 wall = room_wall.inverse();
      const V a = wall * V(hole.min().x(), hole.min().y(), 0),
              b = wall * V(hole.max().x(), hole.max().y(), 0);
      // The hole starts at this wall's inner face (x = 0) and lies behind it.
      if (!own && (std::max(a.x(), b.x()) < -1e-6 || std::max(a.x(), b.x()) > 1e-6 ||
                   alongX(side) != alongX(doorway.side)))
        continue;
      out.push_back({std::min(a.y(), b.y()), std::max(a.y(), b.y()), doorway.height_m, own});
    }
  }
  std::sort(out.begin(), out.end(), [](const Opening& a, const Opening& b) { return a.from < b.from; });
  return out;
}

void panel(MeshBuilder& mesh, double from, double to, double low, double high) {
  if (to - from < 1e-9 || high - low < 1e-9) return;
  mesh.quad({V(0, from, low), V(0, to, low), V(0, to, high), V(0, from, high)});
}

/// One wall as seen from its room; coordinates of wallFrame().
void wall(MeshBuilder& mesh, const World& world, const Room& room, Side side) {
  const Eigen::Vector2d middle = (room.min_m + room.max_m) / 2, size = room.max_m - room.min_m;
  const Pose3 frame = wallFrame(room, side, alongX(side) ? middle.x() : middle.y());
  const double half = (alongX(side) ? size.x() : size.y()) / 2, height = world.wall_height_m;
  const Material board{"paint", toned(room.wall.rgb, 0.62), 1, 0};
  mesh.frame(frame);
  double from = -half;
  const auto solid = [&](double to) {
    mesh.use(room.wall);
    panel(mesh, from, to, 0, height);
    if (to - from > 0.02) mesh.use(board).box({0.006, (from + to) / 2, 0.04}, {0.012, to - from, 0.08});
  };
  for (const auto& opening : openingsOf(world, room, side, frame)) {
    const double a = std::clamp(opening.from, -half, half), b = std::clamp(opening.to, -half, half);
    if (b <= a || a < from - 1e-9) continue;
    solid(a);
    mesh.use(room.wall);
    panel(mesh, a, b, opening.height, height);
    from = b;
    if (!opening.own) continue;
    const double deep = -world.wall_thickness_m;
    mesh.quad({V(deep, a, 0), V(0, a, 0), V(0, a, opening.height), V(deep, a, opening.height)});
    mesh.quad({V(0, b, 0), V(deep, b, 0), V(deep, b, opening.height), V(0, b, opening.height)});
    mesh.quad({V(0, a, opening.height), V(0, b, opening.height), V(deep, b, opening.height),
               V(deep, a, opening.height)});
    mesh.use(room.floor).quad({V(deep, a, 0), V(0, a, 0), V(0, b, 0), V(deep, b, 0)});
  }
  solid(half);
  mesh.frame(Pose3::Identity());
}

void poster(MeshBuilder& mesh, const Room& room, const Poster& poster) {
  mesh.frame(wallFrame(room, poster.side, poster.at_m));
  const double x = 0.02, w = poster.width_m / 2, low = poster.z_m - poster.height_m / 2,
               high = low + poster.height_m;
  mesh.use({poster.pattern, {0.93, 0.93, 0.9}, 1, poster.variant});
  mesh.quad({V(x, -w, low), V(x, w, low), V(x, w, high), V(x, -w, high)}, true);
  mesh.frame(Pose3::Identity());
}

}  // namespace

Pose3 wallFrame(const Room& room, Side side, double at_m) {
  switch (side) {
    case Side::kNorth:
      return poseFromYpr(at_m, room.max_m.y(), 0, -std::numbers::pi / 2, 0, 0);
    case Side::kEast:
      return poseFromYpr(room.max_m.x(), at_m, 0, std::numbers::pi, 0, 0);
    case Side::kSouth:
      return poseFromYpr(at_m, room.min_m.y(), 0, std::numbers::pi / 2, 0, 0);
    case Side::kWest:
      break;
  }
  return poseFromYpr(room.min_m.x(), at_m, 0, 0, 0, 0);
}

PlanBox doorwayHole(const World& world, const Room& room, const Doorway& doorway) {
  const Pose3 frame = wallFrame(room, doorway.side, doorway.at_m);
  const V a = frame * V(0, -doorway.width_m / 2, 0),
          b = frame * V(-world.wall_thickness_m, doorway.width_m / 2, 0);
  PlanBox box(a.head<2>());
  box.extend(Eigen::Vector2d(b.head<2>()));
  return box;
}

std::vector<PlanBox> freeAreas(const World& world) {
  std::vector<PlanBox> out;
  for (const auto& room : world.rooms) {
    out.emplace_back(room.min_m, room.max_m);
    for (const auto& doorway : room.doorways) out.push_back(doorwayHole(world, room, doorway));
  }
  return out;
}

bool discIsFree(const std::vector<PlanBox>& areas, const Eigen::Vector2d& center, double radius) {
  constexpr int kDirections = 24;
  constexpr double kTolerance = 1e-6;
  const auto free = [&](const Eigen::Vector2d& p) {
    return std::any_of(areas.begin(), areas.end(),
                       [&](const PlanBox& box) { return box.exteriorDistance(p) < kTolerance; });
  };
  if (!free(center)) return false;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2 * std::numbers::pi * i / kDirections;
    if (!free(center + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)))) return false;
  }
  return true;
}

Mesh buildingMesh(const World& world, MaterialList& materials) {
  MeshBuilder mesh(materials);
  for (const auto& room : world.rooms) {
    const double x0 = room.min_m.x(), y0 = room.min_m.y(), x1 = room.max_m.x(), y1 = room.max_m.y();
    const double top = world.wall_height_m;
    mesh.use(room.floor).quad({V(x0, y0, 0), V(x1, y0, 0), V(x1, y1, 0), V(x0, y1, 0)});
    mesh.use({"tiles", {0.9, 0.9, 0.89}, 1.25, 0});
    mesh.quad({V(x0, y0, top), V(x0, y1, top), V(x1, y1, top), V(x1, y0, top)});
    for (const Side side : {Side::kNorth, Side::kEast, Side::kSouth, Side::kWest})
      wall(mesh, world, room, side);
    for (const auto& item : room.posters) poster(mesh, room, item);
  }
  return mesh.take();
}

}  // namespace roomgraph
