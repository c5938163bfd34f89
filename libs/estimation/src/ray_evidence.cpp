// SPDX-License-Identifier: BSD-3-Clause
// Sample points in, beside and above the volume of a landmark, and what rays say of them.
#include "ray_evidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <tuple>

namespace roomgraph {
namespace {

constexpr double kStep_m = 0.09, kInset_m = 0.07;  // of sample points in a volume
constexpr double kBesideFrom_m = 0.12, kBesideTo_m = 0.36;
constexpr double kBesideLow_m = 0.15;  // height of the lowest of them
constexpr double kAboveFrom_m = 0.1, kAboveTo_m = 0.4;
constexpr double kAboveShare = 0.6;  // of the footprint's sides: beside an object stand others
constexpr double kLowerPart = 0.5, kUpperPart = 0.7;  // of a door's height
constexpr double kKnown = 0.2;                        // share of points that tells something
constexpr double kDeep_m = 0.35, kDeepAlong_m = 0.5;  // from front and back, from the ends: more than these are off by
constexpr int kSlices = 5;             // of a footprint, along an axis
constexpr double kSliceFilled = 0.15;  // share of a slice's points from which it counts as filled
constexpr double kUsuallyFilled = 0.3, kUsualSpread = 0.7;  // medians of true landmarks
constexpr double kFloorSlack_m = 0.05;  // a lidar whose height nobody measured is said to be on the floor

// From -half to half in even steps of at most kStep_m; 0 alone when there is no room.
std::vector<double> steps(double half_m) {
  if (half_m <= 0) return {0};
  const int count = 1 + static_cast<int>(std::ceil(2 * half_m / kStep_m));
  std::vector<double> out;
  for (int i = 0; i < count; ++i) out.push_back(-half_m + 2 * half_m * i / (count - 1));
  return out;
}

// Points of the footprint, object frame: inside by kInset_m.
std::vector<Eigen::Vector2d> footprintPoints(const ObjectShape& shape) {
  std::vector<Eigen::Vector2d> out;
  const double half_depth = shape.depth / 2 - kInset_m, half_width = shape.width / 2 - kInset_m;
  for (const double x : steps(half_depth))
    for (const double y : steps(half_width))
      if (shape.kind != ShapeKind::kCylinder || std::hypot(x, y) <= half_width) out.emplace_back(x, y);
  return out;
}

// Over the middle of the footprint, just above the object.
std::vector<Eigen::Vector3d> pointsAbove(const ObjectShape& shape) {
  std::vector<Eigen::Vector3d> out;
  for (const auto& p : footprintPoints(shape)) {
    if (std::abs(p.x()) > kAboveShare * shape.depth / 2 || std::abs(p.y()) > kAboveShare * shape.width / 2)
      continue;
    for (double above = kAboveFrom_m; above <= kAboveTo_m; above += kStep_m)
      out.emplace_back(p.x(), p.y(), shape.height + above);
  }
  return out;
}

// In the plane of a planar shape, left, right and above.
std::vector<Eigen::Vector3d> wallPoints(const ObjectShape& shape) {
  std::vector<Eigen::Vector3d> out;
  for (double beside = kBesideFrom_m; beside <= kBesideTo_m; beside += kStep_m) {
    for (double z = kBesideLow_m; z <= shape.height; z += 2 * kStep_m)
      for (const double side : {-1.0, 1.0}) out.emplace_back(0, side * (shape.width / 2 + beside), z);
    for (const double y : steps(shape.width / 2)) out.emplace_back(0, y, shape.height + beside);
  }
  return out;
}

bool mostlyCrossed(const RayCounts& c) {
  return c.crossed > c.filled;
}

bool mostlyFilled(const RayCounts& c) {
  return c.filled > 0 && c.filled >= c.crossed;
}

// Far off, a beam that ends at the front may seem to end a little inside: not where most end before.
bool endsThere(const RayCounts& c) {
  constexpr int kMostBefore = 4;  // times as many as end there
  return mostlyFilled(c) && c.ended_near <= kMostBefore * c.filled;
}

double share(const std::vector<RayCounts>& counts, bool (*is)(const RayCounts&)) {
  if (counts.empty()) return 0;
  return static_cast<double>(std::count_if(counts.begin(), counts.end(), is)) /
         static_cast<double>(counts.size());
}

// A little of a solid object that rays crossed says nearly as much as a lot: the root of the share.
double crossedRoot(const std::vector<RayCounts>& counts) {
  return std::sqrt(share(counts, mostlyCrossed));
}

// Share of the slices across an axis in which enough points are filled.
double filledSlices(const std::vector<Eigen::Vector3d>& points, const std::vector<RayCounts>& counts,
                    int axis, double extent_m) {
  std::array<int, kSlices> all{}, filled{};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double along = points[i][axis] / std::max(extent_m - 2 * kInset_m, kInset_m) + 0.5;
    const auto slice =
        static_cast<std::size_t>(std::clamp(static_cast<int>(along * kSlices), 0, kSlices - 1));
    ++all[slice];
    filled[slice] += mostlyFilled(counts[i]);
  }
  int used = 0, enough = 0;
  for (std::size_t s = 0; s < all.size(); ++s) {
    used += all[s] > 0;
    enough += all[s] > 0 && filled[s] > kSliceFilled * all[s];
  }
  return used ? static_cast<double>(enough) / used : 0;
}

std::vector<Eigen::Vector3d> inWorld(std::vector<Eigen::Vector3d> points, const Pose3& world_from_object) {
  for (auto& p : points) p = world_from_object * p;
  return points;
}

// Of the points about which something is known, the share that was crossed; nothing when that is too few.
std::optional<double> crossedOfKnown(const std::vector<RayCounts>& counts) {
  const double crossed = share(counts, mostlyCrossed), known = crossed + share(counts, mostlyFilled);
  if (known < kKnown) return std::nullopt;
  return crossed / known;
}

// A door is crossed at all heights, or at none; a cupboard below a wall is not. 0 when one part is unknown.
double unevenness(const std::vector<Eigen::Vector3d>& points, const std::vector<RayCounts>& counts,
                  double height_m) {
  std::vector<RayCounts> low, high;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].z() < kLowerPart * height_m) low.push_back(counts[i]);
    if (points[i].z() > kUpperPart * height_m) high.push_back(counts[i]);
  }
  const auto below = crossedOfKnown(low), above = crossedOfKnown(high);
  return below && above ? std::abs(*below - *above) : 0;
}

void setDepthRays(ExistenceEvidence& evidence, const Landmark& landmark, double solid_share,
                  const PosedViews& views) {
  const ObjectShape& shape = landmark.shape;
  const Pose3 world_from_object = landmark.worldFromObject();
  const auto inside = volumePoints(shape);
  const auto counts = views.byImages(inWorld(inside, world_from_object));
  evidence.filled = share(counts, mostlyFilled);
  evidence.spread =
      std::min(filledSlices(inside, counts, 0, shape.depth), filledSlices(inside, counts, 1, shape.width));
  std::vector<RayCounts> solid;
  for (std::size_t i = 0; i < inside.size(); ++i)
    if (inside[i].z() < solid_share * shape.height - kInset_m) solid.push_back(counts[i]);
  evidence.crossed = crossedRoot(solid);
  if (shape.kind != ShapeKind::kPlanar) {
    evidence.above_filled = share(views.byImages(inWorld(pointsAbove(shape), world_from_object)), mostlyFilled);
    return;
  }
  evidence.uneven = unevenness(inside, counts, shape.height);
  const auto wall = views.byImages(inWorld(wallPoints(shape), world_from_object));
  evidence.beside_crossed = crossedRoot(wall);
  evidence.beside_filled = share(wall, mostlyFilled);
}

// Of points of the footprint, object frame, by the scans that pass through the solid part above it.
std::vector<RayCounts> countsOfBeams(const Landmark& landmark, const std::vector<Eigen::Vector2d>& points, double solid_share,
                                     const PosedViews& views) {
  const Pose3 world_from_object = landmark.worldFromObject();
  std::vector<Eigen::Vector2d> ground;
  for (const auto& p : points) ground.push_back((world_from_object * Eigen::Vector3d(p.x(), p.y(), 0)).head<2>());
  const double bottom = landmark.position.z();
  return views.byScans(ground, bottom - kFloorSlack_m, bottom + solid_share * landmark.shape.height);
}

// The part of a footprint that beams reach only where the object is not: its sides end them before.
std::vector<Eigen::Vector2d> deepPoints(const ObjectShape& shape) {
  const double half_depth = shape.depth / 2 - kDeep_m, half_width = shape.width / 2 - kDeepAlong_m;
  if (half_depth <= 0 || half_width <= 0) return {};  // a cabinet: nothing of it is farther inside than its sides may be off
  std::vector<Eigen::Vector2d> out;
  for (const double x : steps(half_depth))
    for (const double y : steps(half_width)) out.emplace_back(x, y);
  return out;
}

// Of what is solid: beams went on through it, or ended deep inside, at a wall that it would stand in.
double beamsAgainst(const Landmark& landmark, double solid_share, const PosedViews& views) {
  const double through =
      crossedRoot(countsOfBeams(landmark, footprintPoints(landmark.shape), solid_share, views));
  if (landmark.shape.kind != ShapeKind::kCuboid) return through;
  const auto deep = countsOfBeams(landmark, deepPoints(landmark.shape), solid_share, views);
  return std::max(through, std::sqrt(share(deep, endsThere)));
}

// Shares: of the points, those about which something is known; of these, those that are filled.
std::pair<double, double> knownAndFilled(const std::vector<RayCounts>& counts) {
  const double filled = share(counts, mostlyFilled), known = filled + share(counts, mostlyCrossed);
  return {known, known > 0 ? filled / known : 0};
}

}  // namespace

std::vector<Eigen::Vector3d> volumePoints(const ObjectShape& shape) {
  std::vector<Eigen::Vector3d> out;
  for (const auto& p : footprintPoints(shape))
    for (double z = kStep_m; z <= shape.height - kInset_m; z += kStep_m) out.emplace_back(p.x(), p.y(), z);
  return out;
}

void setRays(ExistenceEvidence& evidence, const Landmark& landmark, double solid_share,
             const PosedViews& views) {
  if (views.hasImages()) setDepthRays(evidence, landmark, solid_share, views);
  if (solid_share > 0) evidence.beams_crossed = beamsAgainst(landmark, solid_share, views);
  if (evidence.filled == 0 && evidence.crossed == 0) evidence.crossed = evidence.beams_crossed;
  if (views.hasImages()) return;
  evidence.filled = kUsuallyFilled;
  evidence.spread = kUsualSpread;
}

void setRays(PlaceLook& look, const Landmark& landmark, double solid_share, const PosedViews& views) {
  const Pose3 world_from_object = landmark.worldFromObject();
  std::tie(look.known, look.filled) =
      knownAndFilled(views.byImages(inWorld(volumePoints(landmark.shape), world_from_object)));
  if (solid_share == 0) return;
  std::tie(look.beams_known, look.beams_filled) = knownAndFilled(countsOfBeams(landmark, footprintPoints(landmark.shape), solid_share, views));
}

}  // namespace roomgraph
