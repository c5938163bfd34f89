// SPDX-License-Identifier: BSD-3-Clause
// Log odds of two grids, fused objects, trajectories in order of time.
#include "roomgraph/maptools/map_union.h"

#include <algorithm>
#include <cmath>

#include "region.h"
#include "roomgraph/association/landmark_union.h"
#include "roomgraph/tracking/key_views.h"

namespace roomgraph {
namespace {

using mrpt::maps::COccupancyGridMap2D;

constexpr double kLeastExistence = 0.5;
constexpr const char* kContinuedByRun = "continued by a run of ";  // in the history of a map, as `run --map` writes it
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

// Of two maps that share records what both say alike was said once.
float sumOf(float a, float b, bool share_records) {
  if (!share_records || a * b <= 0) return a + b;
  return std::abs(a) > std::abs(b) ? a : b;
}

void addCells(const COccupancyGridMap2D& from, COccupancyGridMap2D& to, bool share_records) {
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
      const float sum = sumOf(odds(from.getCell(x, y)), std::abs(old - 0.5f) < 0.01f ? 0 : odds(old), share_records);
      to.setCell(x + x0, y + y0, 1 / (1 + std::exp(-sum)));
    }
}

COccupancyGridMap2D::Ptr unitedGrids(const COccupancyGridMap2D::Ptr& a, const COccupancyGridMap2D::Ptr& b, bool share_records) {
  if (!a || !b) return a ? a : b;
  auto out = COccupancyGridMap2D::Create();
  out->setSize(std::min(a->getXMin(), b->getXMin()), std::max(a->getXMax(), b->getXMax()),
               std::min(a->getYMin(), b->getYMin()), std::max(a->getYMax(), b->getYMax()),
               a->getResolution());
  out->fill(0.5f);
  addCells(*a, *out, false);
  addCells(*b, *out, share_records);
  return out;
}

// An object in one of two maps, and what its sightings weigh.
struct Known {
  Landmark landmark;
  double weight = 0;
};

// Of two estimates of one object; the class by the weights of their sightings.
Known fused(const Known& a, const Known& b) {
  Known out{fusedEstimates(a.landmark, b.landmark), a.weight + b.weight};
  out.landmark.class_posterior = combinedClasses(a.landmark.class_posterior, a.weight, b.landmark.class_posterior, b.weight);
  out.landmark.existence = combinedExistence(a.landmark.existence, b.landmark.existence);
  return out;
}

// The share of the time of an object's sightings that lies in the common time of two maps.
double shareWithin(const SeenSpans& seen, LandmarkId id, const SeenSpan& common) {
  const auto found = seen.find(id);
  if (found == seen.end()) return 1;
  const auto& [first, last] = found->second;
  if (last < common.first || first > common.last) return 0;
  return last > first ? (std::min(last, common.last) - std::max(first, common.first)) / (last - first) : 1;
}

// As if there were only this share of its sightings.
Known thinned(Known known, double share) {
  Landmark& landmark = known.landmark;
  landmark.covariance /= share;
  landmark.observations = static_cast<int>(std::lround(share * landmark.observations));
  const double sure = std::clamp(landmark.existence, 1e-9, 1 - 1e-9);
  landmark.existence = 1 / (1 + std::pow((1 - sure) / sure, share));
  known.weight *= share;
  return known;
}

// Sightings in the common time of two maps are of the same records: those of the map that has more besides are counted.
Known fusedApart(const Known& a, double shared_a, const Known& b, double shared_b) {
  constexpr double kAll = 0.99;
  const bool thin_b = shared_b >= shared_a;
  const double shared = thin_b ? shared_b : shared_a;
  if (shared > kAll) return thin_b ? a : b;
  return thin_b ? fused(a, thinned(b, 1 - shared)) : fused(thinned(a, 1 - shared), b);
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

void uniteObjects(const CSemanticMap& a, const CSemanticMap& b, const std::vector<ObjectDifference>& difference,
                  const std::optional<SeenSpan>& common, CSemanticMap& out) {
  std::int64_t next = freshIdAfter(a);
  out.landmarks.clear();
  out.weights.clear();
  for (const auto& one : difference) {
    const double before = one.before ? weightOfSightings(a, *one.before) : 0,
                 after = one.after ? weightOfSightings(b, *one.after) : 0;
    Known known{one.before ? *one.before : *one.after, before + after};
    if (one.change == ObjectChange::kStayed) {
      const auto shared = [&](const CSemanticMap& map, const Landmark& object) {
        return common ? shareWithin(map.seen, object.id, *common) : 0;
      };
      known = fusedApart({*one.before, before}, shared(a, *one.before), {*one.after, after}, shared(b, *one.after));
    }
    Landmark& landmark = known.landmark;
    if (one.change == ObjectChange::kMoved) landmark = *one.after;
    landmark.id = one.before ? one.before->id : LandmarkId{next++};
    if (one.change == ObjectChange::kVanished)
      landmark.existence = std::max(0.0, landmark.existence - one.probability);
    if (one.change == ObjectChange::kVanished && landmark.existence < kLeastExistence) {
      out.seen.erase(landmark.id);
      continue;
    }
    noteSeen(one, landmark.id, b, out);
    out.weights[landmark.id] = known.weight;
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
                        const std::vector<ObjectDifference>& difference, const std::optional<SeenSpan>& common) {
  CSemanticMap out = a;
  out.occupancy = unitedGrids(a.occupancy, b.occupancy, common.has_value());
  uniteObjects(a, b, difference, common, out);
  for (const auto& step : b.provenance.history)
    out.provenance.history.push_back("of what was added: " + step);
  out.provenance.history.push_back("united with the map of " + b.origin);
  unitePaths(b, out);
  out.views = unitedViews(a.views, b.views);
  out.origin = a.origin + " + " + b.origin;
  out.planar = a.planar && b.planar;
  return out;
}

bool continues(const CSemanticMap& map, const CSemanticMap& earlier) {
  const auto &all = map.provenance.history, &first = earlier.provenance.history;
  if (first.empty() || all.size() <= first.size() || !std::equal(first.begin(), first.end(), all.begin())) return false;
  // Another recording may have the same name; what stands in both has been seen since the same moment.
  const auto isKnownSince = [&](const auto& seen) {
    const auto found = map.seen.find(seen.first);
    return found == map.seen.end() || found->second.first == seen.second.first;
  };
  if (!std::all_of(earlier.seen.begin(), earlier.seen.end(), isKnownSince)) return false;
  return std::all_of(all.begin() + static_cast<std::ptrdiff_t>(first.size()), all.end(),
                     [](const std::string& step) { return step.starts_with(kContinuedByRun); });
}

}  // namespace roomgraph
