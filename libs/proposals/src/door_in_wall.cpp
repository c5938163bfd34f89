// SPDX-License-Identifier: BSD-3-Clause
// Plane of the wall beside and above a box, and the door between the box's sides on it.
#include "door_in_wall.h"

#include <cmath>

#include "door_on_plane.h"
#include "roomgraph/proposals/shape_fit.h"

namespace roomgraph {
namespace {

constexpr double kLeastHeight_m = 0.3;  // lower points may be a base board's or things on the floor
constexpr double kMostWidths = 3;       // standard deviations of the width that are believed
// What beside a closed door is turned against it by more is no wall, but furniture and wall together.
constexpr double kSameDirection_rad = 0.04, kSameSigmas = 2;
// A leaf is flush with the wall's face or set back by up to the wall's thickness, in the wall's direction;
// one that is turned by more is open.
constexpr double kLeafBefore_m = 0.06, kLeafBehind_m = 0.25, kOpen_rad = 0.25;

constexpr int kLeastOnWall = 12;  // points on a side of the box
constexpr double kLeastShareOnWall = 0.4;

std::vector<Eigen::Vector2d> wallPoints(const BoxEvidence& e) {
  std::vector<Eigen::Vector2d> out;
  for (const auto& p : e.around.points)
    if (p.in_ground.z() > kLeastHeight_m) out.push_back(p.in_ground.head<2>());
  return out;
}

// On how many of the three sides, left, right and above, the plane is the wall. A wall that ends beside the
// door, or comes towards the camera there, is on one.
int sidesOn(const VerticalPlane& wall, const BoxEvidence& e) {
  int all[3] = {}, on_wall[3] = {};
  for (const auto& p : e.around.points) {
    if (p.in_ground.z() <= kLeastHeight_m) continue;
    const int side = p.u < e.box.u_min ? 0 : p.u > e.box.u_max ? 1 : 2;
    ++all[side];
    on_wall[side] += isInlier(wall, p.in_ground.head<2>());
  }
  int sides = 0;
  for (int i = 0; i < 3; ++i) sides += on_wall[i] >= kLeastOnWall && on_wall[i] >= kLeastShareOnWall * all[i];
  return sides;
}

double angleBetween(const VerticalPlane& a, const VerticalPlane& b) {
  return std::acos(std::min(1.0, a.normal.dot(b.normal)));
}

bool isFlush(const VerticalPlane& leaf, const VerticalPlane& wall) {
  const double allowed = kSameDirection_rad + kSameSigmas * std::hypot(leaf.sigma_rad, wall.sigma_rad);
  const Eigen::Vector2d middle = leaf.normal * leaf.offset + leaf.along() * leaf.middle;
  const double before = wall.normal.dot(middle) - wall.offset;  // of the leaf, towards the camera
  return angleBetween(leaf, wall) <= allowed && before <= kLeafBefore_m && before >= -kLeafBehind_m;
}

bool isAnotherWall(const VerticalPlane& leaf, const VerticalPlane& wall) {
  return angleBetween(leaf, wall) <= kOpen_rad && !isFlush(leaf, wall);
}

}  // namespace

std::optional<PlacedShape> doorInWall(const std::optional<VerticalPlane>& leaf, const BoxEvidence& evidence) {
  const auto wall = fitVerticalPlane(wallPoints(evidence));
  if (!wall || sidesOn(*wall, evidence) < 2 || (leaf && isAnotherWall(*leaf, *wall))) return std::nullopt;
  auto placed = doorOnPlane(*wall, evidence, evidence.model->depth_m / 2);
  if (!placed) return std::nullopt;
  const double wrong = std::abs(placed->shape.width - evidence.model->width_m);
  if (wrong > kMostWidths * evidence.model->sizeSigma()[0]) return std::nullopt;
  placed->source = "wall";
  BoxEvidence box_alone = evidence;  // points inside an open door are behind it, or on its leaf
  box_alone.mask = {};
  box_alone.edges = {};
  judge(*placed, box_alone);
  placed->quality *= wall->inlier_share;
  return placed;
}

bool isClosed(const VerticalPlane& leaf, const BoxEvidence& evidence) {
  const auto wall = fitVerticalPlane(wallPoints(evidence));
  return wall && sidesOn(*wall, evidence) >= 1 && isFlush(leaf, *wall);
}

}  // namespace roomgraph
