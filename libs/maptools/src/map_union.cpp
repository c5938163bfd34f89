// SPDX-License-Identifier: BSD-3-Clause
// Log odds of two grids, fused objects, trajectories in order of time.
#include "roomgraph/maptools/map_union.h"

#include "region.h"
#include "roomgraph/association/landmark_union.h"
#include "roomgraph/tracking/key_views.h"

namespace roomgraph {
namespace {

using mrpt::maps::COccupancyGridMap2D;

constexpr double kLeastExistence = 0.5;
constexpr float kSurestCell = 0.99f;
constexpr double kViewsApart_m = 1, kViewsApart_rad = 0.7;  // as a run keeps them

// Where a grid's cell (0, 0) lies in another grid of the same lattice.
std::pair<int, int> offsetIn(const COccupancyGridMap2D& outer, const COccupancyGridMap2D& inner) {
  const double cell = static_cast<double>(outer.getResolution());
  const auto cells = [&](float from, float to) {
    return static_cast<int>(std::lround((static_cast<double>(to) - static_cast<double>(from)) / cell));
  };
  return {cells(outer.getXMin(), inner.getXMin()), cells(outer.getYMin(), inner.getYMin())};
}

void addCells(const COccupancyGridMap2D& from, COccupancyGridMap2D& to) {
  const auto [x0, y0] = offsetIn(to, from);
  const auto odds = [](float p) {
    const float sure = std::clamp(p, 1 - kSurestCell, kSurestCell);
    return std::log(sure / (1 - sure));
  };
  for (int y = 0; y < static_cast<int>(from.getSizeY()); ++y)
    for (int x = 0; x < static_cast<int>(from.getSizeX()); ++x) {
      // Unknown is not quite .5 in eight bits.
      if (std::abs(from.getCell(x, y) - 0.5f) < 0.01f) continue;
      const float old = to.getCell(x + x0, y + y0);
      const float sum = odds(from.getCell(x, y)) + (std::abs(old - 0.5f) < 0.01f ? 0 : odds(old));
      to.setCell(x + x0, y + y0, 1 / (1 + std::exp(-sum)));
    }
}

COccupancyGridMap2D::Ptr unitedGrids(const COccupancyGridMap2D::Ptr& a, const COccupancyGridMap2D::Ptr& b) {
  if (!a || !b) return a ? a : b;
  auto out = COccupancyGridMap2D::Create();
  out->setSize(std::min(a->getXMin(), b->getXMin()), std::max(a->getXMax(), b->getXMax()),
               std::min(a->getYMin(), b->getYMin()), std::max(a->getYMax(), b->getYMax()),
               a->getResolution());
  out->fill(0.5f);
  addCells(*a, *out);
  addCells(*b, *out);
  return out;
}

// Of two estimates of one object; the class by the weights of their sightings.
Landmark fused(const Landmark& a, double weight_a, const Landmark& b, double weight_b) {
  Landmark out = fusedEstimates(a, b);
  out.class_posterior = combinedClasses(a.class_posterior, weight_a, b.class_posterior, weight_b);
  out.existence = combinedExistence(a.existence, b.existence);
  return out;
}

std::int64_t freshIdAfter(const CSemanticMap& map) {
  std::int64_t next = 0;
  for (const auto& landmark : map.landmarks) next = std::max(next, landmark.id.value + 1);
  return next;
}

void noteSeen(const ObjectDifference& one, LandmarkId id, const CSemanticMap& b, CSemanticMap& out) {
  if (!one.after) return;
  const auto later = b.seen.find(one.after->id);
  if (later == b.seen.end()) return;
  const auto [own, is_new] = out.seen.emplace(id, later->second);
  if (is_new) return;
  own->second = {std::min(own->second.first, later->second.first),
                 std::max(own->second.last, later->second.last)};
}

void uniteObjects(const CSemanticMap& a, const CSemanticMap& b,
                  const std::vector<ObjectDifference>& difference, CSemanticMap& out) {
  std::int64_t next = freshIdAfter(a);
  out.landmarks.clear();
  out.weights.clear();
  for (const auto& one : difference) {
    const double before = one.before ? weightOfSightings(a, *one.before) : 0,
                 after = one.after ? weightOfSightings(b, *one.after) : 0;
    Landmark landmark = one.before ? *one.before : *one.after;
    if (one.change == ObjectChange::kStayed) landmark = fused(*one.before, before, *one.after, after);
    if (one.change == ObjectChange::kMoved) landmark = *one.after;
    landmark.id = one.before ? one.before->id : LandmarkId{next++};
    if (one.change == ObjectChange::kVanished)
      landmark.existence = std::max(0.0, landmark.existence - one.probability);
    if (one.change == ObjectChange::kVanished && landmark.existence < kLeastExistence) {
      out.seen.erase(landmark.id);
      continue;
    }
    noteSeen(one, landmark.id, b, out);
    out.weights[landmark.id] = before + after;
    out.landmarks.push_back(landmark);
  }
}

void unitePaths(const CSemanticMap& b, CSemanticMap& out) {
  auto& poses = out.world_from_robot;
  if (b.world_from_robot.empty()) return;
  if (poses.empty() || poses.back().t < b.world_from_robot.front().t)
    poses.insert(poses.end(), b.world_from_robot.begin(), b.world_from_robot.end());
  else if (b.world_from_robot.back().t < poses.front().t)
    poses.insert(poses.begin(), b.world_from_robot.begin(), b.world_from_robot.end());
  else
    out.provenance.history.push_back("poses of " + b.origin + " left out: it overlaps in time");
}

// Of two views of one place the later one; as many as the two maps had at most.
std::vector<KeyView> unitedViews(const std::vector<KeyView>& a, const std::vector<KeyView>& b) {
  std::vector<KeyView> all = a;
  all.insert(all.end(), b.begin(), b.end());
  std::stable_sort(all.begin(), all.end(), [](const KeyView& x, const KeyView& y) { return x.t < y.t; });
  return thinnedViews(std::move(all), a.size() + b.size(), kViewsApart_m, kViewsApart_rad);
}

}  // namespace

CSemanticMap unitedMaps(const CSemanticMap& a, const CSemanticMap& b,
                        const std::vector<ObjectDifference>& difference) {
  CSemanticMap out = a;
  out.occupancy = unitedGrids(a.occupancy, b.occupancy);
  uniteObjects(a, b, difference, out);
  for (const auto& step : b.provenance.history)
    out.provenance.history.push_back("of what was added: " + step);
  out.provenance.history.push_back("united with the map of " + b.origin);
  unitePaths(b, out);
  out.views = unitedViews(a.views, b.views);
  out.origin = a.origin + " + " + b.origin;
  out.planar = a.planar && b.planar;
  return out;
}

}  // namespace roomgraph
