// SPDX-License-Identifier: BSD-3-Clause
// Placing of furniture groups in the rooms of a flat: nothing overlaps, ways stay open.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "flat_grid.h"
#include "flat_groups.h"

namespace roomgraph {
namespace {

constexpr double kWay_m = 0.25;      ///< clearance of the places that must stay connected
constexpr double kCell_m = 0.08;
constexpr int kTries = 30;           ///< places tried for a group
constexpr double kOpenShare = 0.12;  ///< of a room's floor must stay within reach

/// A room while it is furnished.
struct Site {
  const Room* room = nullptr;
  PlanBox area;
  std::vector<Polygon> taken;          ///< furniture, and door leaves
  std::vector<Polygon> kept_free;      ///< before doorways
  std::vector<Eigen::Vector2d> doors;  ///< a place inside, before every passable doorway
};

Site siteOf(const FlatDraft& draft, const Room& room) {
  Site site;
  site.room = &room;
  site.area = PlanBox(room.min_m, room.max_m);
  for (const auto& other : draft.world.rooms) {
    for (const auto& doorway : other.doorways) {
      const bool own = &other == &room;
      const double swing = passable(doorway) ? std::max(0.8, doorway.width_m) : 0.75;
      const PlanBox zone = doorwayZone(draft.world, other, doorway, own ? swing : 0, own ? 0 : 0.75);
      if (!zone.intersects(site.area)) continue;
      const PlanBox inside = zone.intersection(site.area);
      if (inside.sizes().minCoeff() < 0.3) continue;  // it is another wall's
      site.kept_free.push_back(boxPolygon(inside));
      const Pose2 frame = planarPart(wallFrame(other, doorway.side, doorway.at_m));
      const double before = own ? swing + 0.15 : -draft.world.wall_thickness_m - 0.85;  // past an open leaf
      if (passable(doorway)) site.doors.push_back(frame * Eigen::Vector2d(before, 0));
      if (const auto leaf = leafPolygon(other, doorway); own && leaf) site.taken.push_back(*leaf);
    }
  }
  return site;
}

/// Does it stand on the floor or hang on a wall at the height of furniture?
bool takesFloor(const Furniture& item) {
  return item.at_m.z() < 0.01 || item.model == "whiteboard";
}

std::vector<Furniture> moved(const FurnitureGroup& group, const Pose2& frame) {
  std::vector<Furniture> out = group.items;
  for (auto& item : out) {
    const Pose2 pose = frame * Pose2{item.at_m.x(), item.at_m.y(), item.yaw_rad};
    item.at_m = {inSteps(pose.x, 0.001), inSteps(pose.y, 0.001), item.at_m.z()};
    item.yaw_rad = inSteps(wrapAngle(pose.yaw), 1e-5);
  }
  return out;
}

bool fits(const Site& site, const std::vector<Furniture>& items) {
  for (const auto& item : items) {
    const Polygon polygon = floorPolygon(item);
    for (const auto& corner : polygon)
      if (!site.area.contains(corner)) return false;
    if (!takesFloor(item)) continue;
    const auto hit = [&](const Polygon& other) { return touch(polygon, other); };
    if (std::any_of(site.taken.begin(), site.taken.end(), hit) ||
        std::any_of(site.kept_free.begin(), site.kept_free.end(), hit))
      return false;
  }
  return true;
}

/// Enough floor can be walked on, and all doorways are part of it.
bool staysOpen(const Site& site) {
  const FloorGrid grid({site.area}, site.taken, kCell_m);
  Eigen::Vector2d from = site.area.center();
  if (!site.doors.empty()) {
    from = site.doors.front();
  } else {
    double best = 0;
    for (double x = site.area.min().x() + 0.3; x < site.area.max().x(); x += 0.3)
      for (double y = site.area.min().y() + 0.3; y < site.area.max().y(); y += 0.3)
        if (grid.clearance({x, y}) > best) {
          best = grid.clearance({x, y});
          from = {x, y};
        }
  }
  const auto reached = grid.reachable(from, kWay_m);
  if (static_cast<double>(reached.size()) * kCell_m * kCell_m < kOpenShare * site.area.volume()) return false;
  return std::all_of(site.doors.begin(), site.doors.end(), [&](const Eigen::Vector2d& door) {
    return std::any_of(reached.begin(), reached.end(), [&](const auto& cell) { return (cell - door).norm() < 0.3; });
  });
}

/// A place on one of the walls, or anywhere in the room, at which the group is tried.
Pose2 drawPlace(const Site& site, const FurnitureGroup& group, Random& random) {
  if (!group.at_wall) {
    const Eigen::Vector2d margin = 0.25 * site.area.sizes();
    const double x = random.uniform(site.area.min().x() + margin.x(), site.area.max().x() - margin.x()),
                 y = random.uniform(site.area.min().y() + margin.y(), site.area.max().y() - margin.y());
    const bool single = group.items.size() == 1;
    const double yaw = single ? random.uniform(-std::numbers::pi, std::numbers::pi)
                              : drawInt(random, 0, 3) * std::numbers::pi / 2 + 0.04 * random.normal();
    return {x, y, yaw};
  }
  const Side side = static_cast<Side>(drawInt(random, 0, 3));
  const int along = side == Side::kNorth || side == Side::kSouth ? 0 : 1;
  double low = 0, high = 0;  // extent of the group along the wall
  for (const auto& item : group.items)
    for (const auto& corner : floorPolygon(item)) {
      low = std::min(low, corner.y());
      high = std::max(high, corner.y());
    }
  const Pose2 wall = planarPart(wallFrame(*site.room, side, site.area.center()[along]));
  const double half = site.area.sizes()[along] / 2, first = -half - low + 0.02, last = half - high - 0.02;
  const double u = group.fills_corner ? (random.chance(0.5) ? 0 : 1) : random.uniform();
  return wall * Pose2{0, first + u * (last - first), 0};
}

bool place(FlatDraft& draft, Site& site, const FurnitureGroup& group, Random& random) {
  for (int attempt = 0; attempt < kTries; ++attempt) {
    FurnitureGroup now = group;
    if (attempt > kTries / 2) now.fills_corner = false;
    const auto items = moved(now, drawPlace(site, now, random));
    if (!fits(site, items)) continue;
    const std::size_t before = site.taken.size();
    for (const auto& item : items)
      if (takesFloor(item)) site.taken.push_back(floorPolygon(item));
    if (staysOpen(site)) {
      draft.world.furniture.insert(draft.world.furniture.end(), items.begin(), items.end());
      return true;
    }
    site.taken.resize(before);
  }
  return false;
}

}  // namespace

void furnishFlat(FlatDraft& draft, Random& random) {
  static const std::vector<std::string> small{"box", "bin", "plant", "stool", "coat_stand", "wooden_chair"};
  std::vector<Site> sites;
  for (std::size_t i = 0; i < draft.world.rooms.size(); ++i) {
    sites.push_back(siteOf(draft, draft.world.rooms[i]));
    for (const auto& leaf : sites.back().taken) draft.obstacles.push_back(leaf);
    for (const auto& group : groupsFor(draft.uses[i], sites.back().area.volume(), random))
      place(draft, sites.back(), group, random);
  }
  const auto any_site = [&]() -> Site& {
    return sites[static_cast<std::size_t>(drawInt(random, 0, static_cast<int>(sites.size()) - 1))];
  };
  const int rooms = static_cast<int>(sites.size()), wanted = drawInt(random, 8, std::min(24, 9 + 3 * rooms));
  for (int attempt = 0; attempt < 30 && objectsThatCount(draft.world) < wanted; ++attempt) {
    const double u = random.uniform();
    place(draft, any_site(), u < 0.2   ? sofaGroup(random)
                             : u < 0.4 ? chairRow(random)
                             : u < 0.6 ? deskGroup(random)
                                       : standsAlone(drawFurniture("swivel_chair", random)), random);
  }
  for (int attempt = 0; attempt < 60 && objectsThatMislead(draft.world) < objectsThatCount(draft.world); ++attempt)
    place(draft, any_site(), atWall(drawFurniture(pick(random, small), random), random.uniform(0.03, 0.2)), random);
}

}  // namespace roomgraph
