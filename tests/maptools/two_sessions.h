// SPDX-License-Identifier: BSD-3-Clause
// A made-up flat as two sessions map it, each drawn in its own frame from the same walls.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "sample_map.h"

namespace roomgraph::test {

using Wall = std::pair<Eigen::Vector2d, Eigen::Vector2d>;

inline double distanceToWall(const Eigen::Vector2d& p, const Wall& wall) {
  const Eigen::Vector2d along = wall.second - wall.first;
  const double ratio = std::clamp((p - wall.first).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - wall.first - ratio * along).norm();
}

/// 8 m x 6 m, two rooms, nothing symmetrical.
inline std::vector<Wall> flatWalls() {
  return {{{0, 0}, {8, 0}},     {{8, 0}, {8, 4}},       {{8, 4}, {5.5, 4}},     {{5.5, 4}, {5.5, 6}},
          {{5.5, 6}, {0, 6}},   {{0, 6}, {0, 0}},       {{3, 0}, {3, 2.2}},     {{3, 3.4}, {3, 6}},
          {{4.2, 1}, {4.9, 1}}, {{4.9, 1}, {4.9, 1.6}}, {{1, 3.8}, {1.6, 4.2}}, {{6, 3.5}, {6.5, 3.2}}};
}
/// 6 m x 6 m: looks the same from four sides.
inline std::vector<Wall> squareWalls() {
  return {{{0, 0}, {6, 0}}, {{6, 0}, {6, 6}}, {{6, 6}, {0, 6}}, {{0, 6}, {0, 0}}};
}
/// Another flat.
inline std::vector<Wall> otherWalls() {
  return {{{0, 0}, {5, 0}},       {{5, 0}, {5, 9}},       {{5, 9}, {2, 9}},       {{2, 9}, {2, 6.5}},
          {{2, 6.5}, {0, 6.5}},   {{0, 6.5}, {0, 0}},     {{0, 3.1}, {1.7, 3.1}}, {{2.8, 3.1}, {5, 3.1}},
          {{3.5, 5}, {4.3, 5.9}}, {{1, 1.2}, {1.4, 2.1}}, {{3, 7.2}, {3.7, 7.2}}, {{3.6, 1}, {4.1, 1.6}}};
}

/// Grid of the walls in a frame; inside their bounds everything else is free, but cells that `hidden` takes
/// (world) are unknown.
template <class Hidden>
mrpt::maps::COccupancyGridMap2D::Ptr drawWalls(const std::vector<Wall>& walls, const Pose2& frame_from_world,
                                               const Hidden& hidden) {
  auto grid = mrpt::maps::COccupancyGridMap2D::Create(-14.f, 14.f, -14.f, 14.f, 0.05f);
  grid->fill(0.5f);
  Eigen::AlignedBox2d bounds;
  for (const auto& [a, b] : walls) bounds.extend(a).extend(b);
  const Pose2 world_from_frame = frame_from_world.inverse();
  for (int y = 0; y < static_cast<int>(grid->getSizeY()); ++y)
    for (int x = 0; x < static_cast<int>(grid->getSizeX()); ++x) {
      const Eigen::Vector2d p =
          world_from_frame * Eigen::Vector2d(-14 + (x + 0.5) * 0.05, -14 + (y + 0.5) * 0.05);
      const bool wall =
          std::any_of(walls.begin(), walls.end(), [&](const Wall& w) { return distanceToWall(p, w) < 0.05; });
      if (!hidden(p) && (wall || bounds.contains(p))) grid->setCell(x, y, wall ? 0.02f : 0.98f);
    }
  return grid;
}

inline Landmark objectAt(std::int64_t id, const std::string& class_name, double x, double y, double yaw = 0) {
  const bool round = class_name == "swivel_chair";
  Landmark landmark = sampleLandmark(id, class_name, round ? ShapeKind::kCylinder : ShapeKind::kCuboid, x, y);
  landmark.shape = round ? ObjectShape{ShapeKind::kCylinder, 0.6, 0.6, 0.9}
                         : ObjectShape{ShapeKind::kCuboid, 1.8, 0.9, 0.8};
  landmark.yaw = yaw;
  landmark.covariance = 9e-4 * Eigen::Matrix4d::Identity();
  landmark.existence = 0.95;
  return landmark;
}

/// The objects of the flat, in world.
inline std::vector<Landmark> flatObjects() {
  return {objectAt(1, "swivel_chair", 1, 1),     objectAt(2, "swivel_chair", 2.2, 2),
          objectAt(3, "swivel_chair", 6.5, 1.2), objectAt(4, "swivel_chair", 4.4, 5),
          objectAt(5, "sofa", 1.6, 5.4, -1.57),  objectAt(6, "sofa", 7.3, 2, 3.1)};
}

/// The map of a session: objects given in world, everything in the session's frame.
template <class Hidden>
CSemanticMap sessionMap(const std::vector<Wall>& walls, const std::vector<Landmark>& objects,
                        const Pose2& frame_from_world, double start_s, const Hidden& hidden) {
  CSemanticMap map;
  map.origin = "session at " + std::to_string(static_cast<int>(start_s));
  map.occupancy = drawWalls(walls, frame_from_world, hidden);
  map.landmarks = objects;
  for (auto& object : map.landmarks) {
    object.position.head<2>() = frame_from_world * Eigen::Vector2d(object.position.head<2>());
    object.yaw = wrapAngle(object.yaw + frame_from_world.yaw);
  }
  for (int i = 0; i < 5; ++i)
    map.world_from_robot.push_back({start_s + i, toPose3(frame_from_world * Pose2{1.0 + i, 2.8, 0})});
  return map;
}
inline CSemanticMap sessionMap(const std::vector<Wall>& walls, const std::vector<Landmark>& objects,
                               const Pose2& frame_from_world, double start_s = 1000) {
  return sessionMap(walls, objects, frame_from_world, start_s, [](const Eigen::Vector2d&) { return false; });
}

}  // namespace roomgraph::test
