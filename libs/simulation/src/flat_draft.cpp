// SPDX-License-Identifier: BSD-3-Clause
// Random choices and plane geometry of the generator of flats.
#include "flat_draft.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "models.h"
#include "roomgraph/core/errors.h"
#include "world_check.h"

namespace roomgraph {
namespace {

/// Does a line along an edge of `a` separate the polygons?
bool separated(const Polygon& a, const Polygon& b) {
  constexpr double kTolerance = 1e-9;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Eigen::Vector2d edge = a[(i + 1) % a.size()] - a[i], out(edge.y(), -edge.x());
    if (std::all_of(b.begin(), b.end(), [&](const auto& p) { return out.dot(p - a[i]) > -kTolerance; })) return true;
  }
  return false;
}

}  // namespace

double inSteps(double value, double step) {
  return std::round(value / step) * step;
}

int drawInt(Random& random, int low, int high) {
  return low + std::min(high - low, static_cast<int>(random.uniform() * (high - low + 1)));
}

double drawSkewed(Random& random, double low, double high, double power) {
  return inSteps(low + (high - low) * std::pow(random.uniform(), power));
}

Polygon boxPolygon(const PlanBox& box) {
  return {box.min(), {box.max().x(), box.min().y()}, box.max(), {box.min().x(), box.max().y()}};
}

Polygon floorPolygon(const Furniture& item) {
  static const std::vector<std::string> round{"round_table", "stool", "plant", "bin", "coat_stand"};
  constexpr int kCorners = 16;
  const Eigen::Vector3d size = item.size_m.value_or(furnitureModel(item.model).size_m);
  const Pose2 pose{item.at_m.x(), item.at_m.y(), item.yaw_rad};
  const double x = size.y() / 2, y = size.x() / 2;
  Polygon out;
  if (std::find(round.begin(), round.end(), item.model) == round.end()) {
    for (const auto& corner : {Eigen::Vector2d(x, y), Eigen::Vector2d(-x, y), Eigen::Vector2d(-x, -y), Eigen::Vector2d(x, -y)})
      out.push_back(pose * corner);
    return out;
  }
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCorners;
    out.push_back(pose * Eigen::Vector2d(x * std::cos(angle), y * std::sin(angle)));
  }
  return out;
}

bool touch(const Polygon& a, const Polygon& b) {
  return !separated(a, b) && !separated(b, a);
}

std::optional<Polygon> leafPolygon(const Room& room, const Doorway& doorway) {
  if (doorway.door != DoorState::kOpen && doorway.door != DoorState::kHalfOpen) return std::nullopt;
  // As doorMesh() builds it: hinged at the left post, its handle near the other end.
  constexpr double kFrame = 0.063, kHandle = 0.05, kLeaf = 0.04;
  const double angle = doorway.door == DoorState::kOpen ? 1.5 : 0.8, length = doorway.width_m - 2 * kFrame;
  const Pose2 hinge = planarPart(wallFrame(room, doorway.side, doorway.at_m)) *
                      Pose2{0, doorway.width_m / 2 - kFrame, angle};
  Polygon out;
  for (const auto& corner :
       {Eigen::Vector2d(kHandle, 0), Eigen::Vector2d(-kLeaf - kHandle, 0), Eigen::Vector2d(-kLeaf - kHandle, -length),
        Eigen::Vector2d(kHandle, -length)})
    out.push_back(hinge * corner);
  return out;
}

PlanBox doorwayZone(const World& world, const Room& room, const Doorway& doorway, double inside, double outside) {
  const Pose2 frame = planarPart(wallFrame(room, doorway.side, doorway.at_m));
  PlanBox out;
  for (const double side : {-1.0, 1.0}) {
    out.extend(frame * Eigen::Vector2d(inside, side * doorway.width_m / 2));
    out.extend(frame * Eigen::Vector2d(-world.wall_thickness_m - outside, side * doorway.width_m / 2));
  }
  return out;
}

int objectsThatCount(const World& world) {
  int out = 0;
  for (const auto& item : world.furniture) out += item.model == "swivel_chair" || item.model == "sofa";
  for (const auto& room : world.rooms)
    out += static_cast<int>(std::count_if(room.doorways.begin(), room.doorways.end(),
                                          [](const Doorway& doorway) { return doorway.door != DoorState::kNone; }));
  return out;
}

bool isSound(const World& world) {
  try {
    checkWorld(world);
    return true;
  } catch (const ConfigError&) {
    return false;
  }
}

int objectsThatMislead(const World& world) {
  return static_cast<int>(std::count_if(world.furniture.begin(), world.furniture.end(), [](const Furniture& item) {
    return item.model != "swivel_chair" && item.model != "sofa" && item.model != "desk";
  }));
}

bool passable(const Doorway& doorway) {
  return doorway.door != DoorState::kClosed;
}

}  // namespace roomgraph
