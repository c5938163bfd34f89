// SPDX-License-Identifier: BSD-3-Clause
// Plane of the wall beside and above a box, and the door between the box's sides on it.
#include "door_in_wall.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "door_on_plane.h"
#include "roomgraph/proposals/shape_fit.h"

namespace roomgraph {
namespace {

constexpr double kLeastHeight_m = 0.3;  // lower points may be a base board's or things on the floor
// Standard deviations of the width that are believed, also where the wall is seen on one side only.
constexpr double kMostWidths = 3, kMostWidthsOneSide = 2;
// What beside a closed door is turned against it by more is no wall, but furniture and wall together.
constexpr double kSameDirection_rad = 0.04, kSameSigmas = 2;
// A leaf is flush with the wall's face or set back by up to the wall's thickness, in the wall's direction;
// one that is turned by more is open.
constexpr double kLeafBefore_m = 0.06, kLeafBehind_m = 0.25, kOpen_rad = 0.25;

// An open leaf: turned against its wall by at least so much, an end this near to the wall; on the wall beside
// its hinge nothing is seen where the doorway is, between this distance from the hinge and the usual width
// less it.
constexpr double kAjar_rad = 0.6, kAtHinge_m = 0.15, kJamb_m = 0.15;
constexpr double kBesideHinge_m = 1.2;  // wall points farther off may be another wall's
constexpr double kStrayShare = 0.1;     // of points that may be elsewhere
constexpr double kBehind_m = 0.25;      // what is not part of a wall is so far behind it

// The front of a cupboard or a shelf is so far before its wall.
constexpr double kCupboardFrom_m = 0.12, kCupboardTo_m = 0.7;

// Of the points in the box of a doorway whose wall is seen on one side only, so many are behind the wall, and
// on it no more than so many.
constexpr double kLeastThrough = 0.4, kMostOnWall = 0.3;
constexpr double kFrameShare = 0.08, kLeastFrame_px = 60;
constexpr double kOfOneSide = 0.8;  // of the quality

constexpr int kLeastOnWall = 12;  // points on a side of the box
constexpr double kLeastShareOnWall = 0.4;

constexpr double kEverywhere = std::numeric_limits<double>::infinity();

// Of the image columns between two.
std::vector<Eigen::Vector2d> wallPoints(const BoxEvidence& e, double from_u = -kEverywhere,
                                        double to_u = kEverywhere) {
  std::vector<Eigen::Vector2d> out;
  for (const auto& p : e.around.points)
    if (p.in_ground.z() > kLeastHeight_m && p.u > from_u && p.u < to_u) out.push_back(p.in_ground.head<2>());
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

// How far the leaf's points are before the wall, towards the camera, m.
double beforeWall(const VerticalPlane& leaf, const VerticalPlane& wall) {
  const Eigen::Vector2d middle = leaf.normal * leaf.offset + leaf.along() * leaf.middle;
  return wall.normal.dot(middle) - wall.offset;
}

bool isFlush(const VerticalPlane& leaf, const VerticalPlane& wall) {
  const double allowed = kSameDirection_rad + kSameSigmas * std::hypot(leaf.sigma_rad, wall.sigma_rad);
  const double before = beforeWall(leaf, wall);
  return angleBetween(leaf, wall) <= allowed && before <= kLeafBefore_m && before >= -kLeafBehind_m;
}

// Share of the points above the box that lie on the plane; of few points none.
double shareAbove(const VerticalPlane& plane, const BoxEvidence& e) {
  int above = 0, on_plane = 0;
  for (const auto& p : e.around.points) {
    if (p.u < e.box.u_min || p.u > e.box.u_max) continue;
    ++above;
    on_plane += isInlier(plane, p.in_ground.head<2>());
  }
  return above >= kLeastOnWall ? static_cast<double>(on_plane) / above : 0;
}

// Whether the door is in the plane of the points in the box, and what is beside it is furniture before that
// plane: it goes on above the box, or the box ends where it meets the floor.
bool standsBehind(const VerticalPlane& leaf, const VerticalPlane& wall, const BoxEvidence& e) {
  if (shareAbove(leaf, e) >= kLeastShareOnWall) return true;
  const auto contact = contactPoint(e);
  return contact && leaf.normal.dot(*contact) - leaf.offset < wall.offset - wall.normal.dot(*contact);
}

// A parallel plane before the wall is the front of a cupboard; behind it, it may be what is seen through the
// doorway.
bool isAnotherWall(const VerticalPlane& leaf, const VerticalPlane& wall, const BoxEvidence& e) {
  if (angleBetween(leaf, wall) > kOpen_rad || isFlush(leaf, wall)) return false;
  return beforeWall(leaf, wall) > -kLeafBehind_m || standsBehind(leaf, wall, e);
}

// Where the line of sight to a point meets the plane, as a coordinate along it; infinite beyond its vanishing
// point.
double sightOn(const VerticalPlane& plane, const Eigen::Vector2d& p) {
  const double slope = plane.normal.dot(p);
  if (slope >= 0) return std::copysign(std::numeric_limits<double>::infinity(), plane.along().dot(p));
  return plane.along().dot(p) * plane.offset / slope;
}

// Along the wall: where the hinge is, and in which direction the doorway.
struct Doorway {
  double hinge = 0, direction = 0;
};

// Whether the wall is seen near the hinge and, where the doorway is to be, only what is behind it: the next
// room, or nothing, as something hides it.
bool endsAtHinge(const VerticalPlane& wall, const Doorway& doorway, bool hidden, const BoxEvidence& e) {
  int beside = 0, in_doorway = 0, through = 0;
  for (const auto& p : wallPoints(e)) {
    const bool on_wall = isInlier(wall, p);
    const double from_hinge = doorway.direction * (sightOn(wall, p) - doorway.hinge);
    beside += on_wall && std::abs(from_hinge) < kBesideHinge_m;
    if (from_hinge < kJamb_m || from_hinge > e.model->width_m - kJamb_m) continue;
    in_doorway += on_wall;
    through += wall.normal.dot(p) < wall.offset - kBehind_m;
  }
  return beside >= kLeastOnWall && in_doorway <= kStrayShare * beside && (hidden || through >= kLeastOnWall);
}

// Whether what is seen beside the leaf's other end is behind it, as beside nothing that is part of a wall.
bool endsFreely(const VerticalPlane& leaf, const Eigen::Vector2d& hinge, const BoxEvidence& e) {
  const double away = leaf.along().dot(hinge) > leaf.middle ? -1 : 1;
  int all = 0, behind = 0;
  for (const auto& p : wallPoints(e)) {
    if (away * (sightOn(leaf, p) - leaf.middle) < 0) continue;
    ++all;
    behind += leaf.normal.dot(p) < leaf.offset - kBehind_m;
  }
  return all >= kLeastOnWall && behind > (1 - kStrayShare) * all;
}

// Of the points, those that are behind the leaf, as nothing is that is part of its wall; 0 of too few.
double shareBehind(const VerticalPlane& leaf, const std::vector<Eigen::Vector2d>& points) {
  if (points.size() < kLeastOnWall) return 0;
  const auto behind = std::count_if(points.begin(), points.end(), [&](const Eigen::Vector2d& p) {
    return leaf.normal.dot(p) < leaf.offset - kBehind_m;
  });
  return static_cast<double>(behind) / static_cast<double>(points.size());
}

// The doorway beside the hinge of an open leaf, where the wall ends: on the camera's side of the leaf, or,
// when the leaf plainly does not stand in a wall itself, hidden behind it.
std::optional<Doorway> besideLeaf(const VerticalPlane& leaf, const PlacedShape& on_leaf,
                                  const VerticalPlane& wall, const BoxEvidence& e) {
  Eigen::Matrix2d normals;
  normals << leaf.normal.transpose(), wall.normal.transpose();
  const Eigen::Vector2d hinge = normals.inverse() * Eigen::Vector2d(leaf.offset, wall.offset);
  const double from_middle = std::abs(leaf.along().dot(hinge - Eigen::Vector2d(on_leaf.x, on_leaf.y)));
  if (std::abs(from_middle - on_leaf.shape.width / 2) > kAtHinge_m) return std::nullopt;
  const double towards_camera = leaf.normal.dot(wall.along()) > 0 ? 1 : -1;
  const Doorway seen{wall.along().dot(hinge), towards_camera}, hidden{seen.hinge, -towards_camera};
  if (endsAtHinge(wall, seen, false, e)) return seen;
  if (endsAtHinge(wall, hidden, true, e) && endsFreely(leaf, hinge, e)) return hidden;
  return std::nullopt;
}

// A door of the usual width between the hinge and where the wall goes on.
PlacedShape onWall(const VerticalPlane& wall, const Doorway& doorway, const BoxEvidence& e) {
  PlacedShape placed;
  placed.shape = e.model->nominal();
  const double seat_m = e.model->depth_m / 2;
  standOn(placed, wall, doorway.hinge + doorway.direction * placed.shape.width / 2, seat_m);
  placed.source = "open leaf";
  placed.place_by_size(1, 0) = doorway.direction / 2;
  const double along = std::hypot(kAtHinge_m, e.model->sizeSigma()[0]) / 2,
               across = std::hypot(wall.sigma_m, seat_m);
  placed.covariance = Eigen::Matrix3d::Zero();
  placed.covariance->topLeftCorner<2, 2>() = along * along * wall.along() * wall.along().transpose() +
                                             across * across * wall.normal * wall.normal.transpose();
  (*placed.covariance)(2, 2) = wall.sigma_rad * wall.sigma_rad;
  return placed;
}

// Whether the next room is seen in the box, through the wall's plane.
bool seenThrough(const VerticalPlane& wall, const BoxEvidence& e) {
  int all = 0, on_wall = 0, behind = 0;
  for (const auto& p : e.all.points) {
    if (p.in_ground.z() <= kLeastHeight_m) continue;
    ++all;
    on_wall += isInlier(wall, p.in_ground.head<2>());
    behind += wall.normal.dot(p.in_ground.head<2>()) < wall.offset - kBehind_m;
  }
  return all >= kLeastOnWall && behind >= kLeastThrough * all && on_wall <= kMostOnWall * all;
}

// Whether the door's frame, just inside the side of the box, is on the wall.
bool frameOnWall(const VerticalPlane& wall, bool on_left, const BoxEvidence& e) {
  const double width = kFrameShare * std::max(e.box.width(), kLeastFrame_px);
  int all = 0, on_wall = 0;
  for (const auto& p : e.all.points) {
    if (p.in_ground.z() <= kLeastHeight_m) continue;
    if ((on_left ? p.u - e.box.u_min : e.box.u_max - p.u) > width) continue;
    ++all;
    on_wall += isInlier(wall, p.in_ground.head<2>());
  }
  return all > 0 && on_wall >= kLeastShareOnWall * all;
}

// In standard deviations of the usual width.
double widthDeviation(const PlacedShape& door, const BoxEvidence& e) {
  return std::abs(door.shape.width - e.model->width_m) / e.model->sizeSigma()[0];
}

// Without the points in the box: those inside an open door are behind it, or on its leaf.
void judgeByBox(PlacedShape& placed, BoxEvidence evidence) {
  evidence.mask = {};
  evidence.edges = {};
  judge(placed, evidence);
}

}  // namespace

std::optional<PlacedShape> doorInWall(const std::optional<VerticalPlane>& leaf, const BoxEvidence& evidence) {
  const auto wall = fitVerticalPlane(wallPoints(evidence));
  if (!wall || sidesOn(*wall, evidence) < 2 || (leaf && isAnotherWall(*leaf, *wall, evidence)))
    return std::nullopt;
  auto placed = doorOnPlane(*wall, evidence, evidence.model->depth_m / 2);
  if (!placed) return std::nullopt;
  if (widthDeviation(*placed, evidence) > kMostWidths) return std::nullopt;
  placed->source = "wall";
  judgeByBox(*placed, evidence);
  placed->quality *= wall->inlier_share;
  return placed;
}

std::optional<PlacedShape> doorSeenThrough(const std::optional<VerticalPlane>& leaf,
                                           const BoxEvidence& evidence) {
  std::optional<PlacedShape> best;
  for (const bool on_left : {true, false}) {
    const auto wall = fitVerticalPlane(on_left ? wallPoints(evidence, -kEverywhere, evidence.box.u_min)
                                               : wallPoints(evidence, evidence.box.u_max, kEverywhere));
    if (!wall) continue;
    if (leaf && isFlush(*leaf, *wall)) return std::nullopt;
    if (leaf && angleBetween(*leaf, *wall) <= kOpen_rad && standsBehind(*leaf, *wall, evidence))
      return std::nullopt;
    if (!seenThrough(*wall, evidence) || !frameOnWall(*wall, on_left, evidence)) continue;
    auto placed = doorOnPlane(*wall, evidence, evidence.model->depth_m / 2);
    if (!placed || widthDeviation(*placed, evidence) > kMostWidthsOneSide) continue;
    judgeByBox(*placed, evidence);
    placed->source = "one side of the wall";
    placed->quality *= kOfOneSide * wall->inlier_share;
    if (!best || placed->quality > best->quality) best = placed;
  }
  return best;
}

std::optional<PlacedShape> doorwayOfLeaf(const VerticalPlane& leaf, const PlacedShape& on_leaf,
                                         const BoxEvidence& evidence) {
  std::optional<PlacedShape> best;
  for (const auto& points : {wallPoints(evidence, -kEverywhere, evidence.box.u_min),
                             wallPoints(evidence, evidence.box.u_max, kEverywhere)}) {
    const auto wall = fitVerticalPlane(points);
    if (!wall || angleBetween(leaf, *wall) < kAjar_rad) continue;
    const double quality = on_leaf.quality * wall->inlier_share;
    if (best && best->quality >= quality) continue;
    const auto doorway = besideLeaf(leaf, on_leaf, *wall, evidence);
    if (!doorway) continue;
    best = onWall(*wall, *doorway, evidence);
    best->quality = quality;
    best->box_iou = on_leaf.box_iou;
  }
  return best;
}

bool standsOpen(const VerticalPlane& leaf, const BoxEvidence& evidence) {
  bool across = false, before_space = false;
  for (const auto& points : {wallPoints(evidence, -kEverywhere, evidence.box.u_min),
                             wallPoints(evidence, evidence.box.u_max, kEverywhere)}) {
    before_space |= shareBehind(leaf, points) > kStrayShare;
    const auto wall = fitVerticalPlane(points);
    if (!wall) continue;
    if (isFlush(leaf, *wall)) return false;
    across |= angleBetween(leaf, *wall) > kAjar_rad;
  }
  return across && before_space;
}

bool isFurniture(const VerticalPlane& leaf, const BoxEvidence& evidence) {
  bool before_wall = false;
  for (const auto& points : {wallPoints(evidence, -kEverywhere, evidence.box.u_min),
                             wallPoints(evidence, evidence.box.u_max, kEverywhere), wallPoints(evidence)}) {
    const auto wall = fitVerticalPlane(points);
    if (!wall) continue;
    if (isFlush(leaf, *wall)) return false;
    const double before = beforeWall(leaf, *wall);
    before_wall |=
        angleBetween(leaf, *wall) <= kOpen_rad && before > kCupboardFrom_m && before < kCupboardTo_m;
  }
  return before_wall;
}

bool isClosed(const VerticalPlane& leaf, const BoxEvidence& evidence) {
  const auto wall = fitVerticalPlane(wallPoints(evidence));
  return wall && sidesOn(*wall, evidence) >= 1 && isFlush(leaf, *wall);
}

}  // namespace roomgraph
