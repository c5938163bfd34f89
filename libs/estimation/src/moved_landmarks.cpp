// SPDX-License-Identifier: BSD-3-Clause
// The change of place in a series of sightings, and what rays say of it.
#include "moved_landmarks.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "ray_evidence.h"
#include "roomgraph/core/order_statistics.h"
#include "roomgraph/geometry/shape_math.h"

namespace roomgraph {
namespace {

constexpr double kMovedPause_s = 3;      // an object not seen for so long begins a new visit
constexpr std::size_t kLeastBoth = 3;    // sightings before and after
constexpr double kLeastVisit_s = 1;      // from the first of them to the last: more than a moment's error
constexpr int kLatest = 20;              // pauses: what was moved before was followed then
constexpr double kLeastMoved_m = 0.25;   // what sightings from one side and from the other may differ by
constexpr double kScatters = 2;          // times what a quarter of them is off their median place
constexpr double kMostOfThem = 0.75;
constexpr double kBesideOther_m = 0.1;   // from the volume at the other place
constexpr int kLeastPoints = 8;          // that tell something
constexpr double kLeastChanged = 0.6;    // share of them
constexpr double kStillThere = 0.4;      // share of them up to which nothing is gone
constexpr double kEver_s = std::numeric_limits<double>::infinity();

using Seen = std::vector<PlaceInTime>;

// Sightings of one place.
struct Place {
  Eigen::Vector2d median = Eigen::Vector2d::Zero();
  double distances = 0, scatter = 0;  // m: sum of the distances from it, and what most are within
};

Place placeOf(Seen::const_iterator first, Seen::const_iterator last) {
  std::vector<double> x, y, distances;
  for (auto seen = first; seen != last; ++seen) x.push_back(seen->place.x()), y.push_back(seen->place.y());
  Place out{.median = {median(std::move(x)), median(std::move(y))}};
  for (auto seen = first; seen != last; ++seen) {
    distances.push_back((seen->place - out.median).norm());
    out.distances += distances.back();
  }
  out.scatter = quantile(std::move(distances), kMostOfThem);
  return out;
}

// The middle for the landmark's size: the end that was seen stays where it is (see atSize()), but where width was taken for depth.
Eigen::Vector2d placeAtSize(const Pose3& world_from_object, const Proposal& proposal, const Landmark& landmark) {
  const double yaw = planarPart(world_from_object).yaw;
  if (std::abs(std::sin(yaw - landmark.yaw)) > std::numbers::sqrt2 / 2) return world_from_object.translation().head<2>();
  const Eigen::Vector3d longer = sizeOf(landmark.shape) - sizeOf(proposal.shape);
  return world_from_object.translation().head<2>() + Eigen::Rotation2Dd(yaw) * (proposal.place_by_size * longer);
}

using SeenByLandmark = std::map<LandmarkId, Seen>;

bool standInEachOther(const Landmark& a, const Landmark& b) {
  return a.class_name == b.class_name && (a.position - b.position).head<2>().norm() < a.shape.horizontalExtent();
}

using ById = std::map<LandmarkId, const Landmark*>;

// Those that were sighted at that time or later, and what stands where one of these cannot stand beside it.
ById concerned(const std::vector<Landmark>& landmarks, const ObjectFrames& frames, double since_t) {
  std::set<LandmarkId> sighted;
  for (std::size_t i = frames.size(); i-- > 0 && frames[i].t >= since_t;)
    for (const auto& decision : frames[i].decisions) sighted.insert(decision.landmark);
  ById out;
  for (const Landmark& landmark : landmarks) {
    if (!sighted.contains(landmark.id)) continue;
    out[landmark.id] = &landmark;
    for (const Landmark& other : landmarks)
      if (standInEachOther(landmark, other)) out[other.id] = &other;
  }
  return out;
}

// Without boxes that were carried from the detection before. Of those that were given up enough are kept.
SeenByLandmark seenPlaces(const ById& landmarks, const ObjectFrames& frames, const KeyPoses& poses) {
  SeenByLandmark out;
  for (const auto& frame : frames) {
    std::optional<Pose3> world_from_camera;  // blended from key poses: only where it is needed
    for (const auto& decision : frame.decisions) {
      const auto landmark = landmarks.find(decision.landmark);
      const Proposal& proposal = decision.seen.measurement.proposal;
      if (landmark == landmarks.end() || proposal.class_name != landmark->second->class_name) continue;
      if (decision.seen.measurement.detection.carried) continue;
      if (!world_from_camera) world_from_camera = poses.at(frame.t) * frame.robot_from_camera;
      const Pose3 world_from_object = *world_from_camera * proposal.camera_from_object;
      out[decision.landmark].push_back({frame.t, placeAtSize(world_from_object, proposal, *landmark->second)});
    }
  }
  return out;
}

// Nothing of two that were seen in one image.
Seen ofOneObject(const Seen& a, const Seen& b) {
  Seen out;
  std::merge(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(out), [](const auto& x, const auto& y) { return x.t < y.t; });
  const auto at_once = [](const auto& x, const auto& y) { return x.t == y.t; };
  if (std::adjacent_find(out.begin(), out.end(), at_once) != out.end()) out.clear();
  return out;
}

// Points of the volume at `here` that are not in the one at `there`, world.
std::vector<Eigen::Vector3d> onlyHere(const ObjectShape& shape, const Pose3& here, const Pose3& there) {
  std::vector<Eigen::Vector3d> out;
  for (const Eigen::Vector3d& p : volumePoints(shape)) {
    const Eigen::Vector3d in_world = here * p;
    if (distanceOutside<double>(shape.kind, sizeOf(shape), there.inverse() * in_world)[0] > kBesideOther_m) out.push_back(in_world);
  }
  return out;
}

// Of the points that are filled in some views the share that is free in the others.
double freeShare(const std::vector<Eigen::Vector3d>& points, const PosedViews& filled_in, const PosedViews& free_in) {
  const auto with = filled_in.byImages(points), without = free_in.byImages(points);
  int known = 0, free = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (with[i].filled <= with[i].crossed || without[i].filled + without[i].crossed == 0) continue;
    ++known;
    free += without[i].crossed > without[i].filled;
  }
  return known < kLeastPoints ? 0 : static_cast<double>(free) / known;
}

}  // namespace

std::optional<ChangeOfPlace> changeOfPlace(const std::vector<PlaceInTime>& seen) {
  std::optional<ChangeOfPlace> out;
  double least = std::numeric_limits<double>::infinity();
  int pauses = 0;
  for (std::size_t k = seen.size(); k-- > kLeastBoth && pauses < kLatest;) {
    const PlaceInTime &last = seen[k - 1], &first = seen[k];
    if (seen.size() - k < kLeastBoth || first.t - last.t < kMovedPause_s) continue;
    ++pauses;
    if (last.t - seen.front().t < kLeastVisit_s || seen.back().t - first.t < kLeastVisit_s) continue;
    const auto middle = seen.begin() + static_cast<std::ptrdiff_t>(k);
    const Place before = placeOf(seen.begin(), middle), after = placeOf(middle, seen.end());
    if (before.distances + after.distances >= least) continue;
    least = before.distances + after.distances;
    out.reset();
    if ((after.median - before.median).norm() >= std::max(kLeastMoved_m, kScatters * std::max(before.scatter, after.scatter)))
      out = {seen.front().t, last.t, first.t, before.median, after.median};
  }
  return out;
}

std::vector<MovedLandmark> movedLandmarks(const std::vector<Landmark>& landmarks, const ObjectFrames& frames, const KeyPoses& poses,
                                          double since_t) {
  const SeenByLandmark seen = seenPlaces(concerned(landmarks, frames, since_t), frames, poses);
  std::vector<MovedLandmark> alone, pairs;
  for (const Landmark& landmark : landmarks) {
    const auto own = seen.find(landmark.id);
    if (landmark.shape.kind == ShapeKind::kPlanar || own == seen.end() || own->second.back().t < since_t) continue;
    if (const auto change = changeOfPlace(own->second)) alone.push_back({landmark.id, {}, *change});
    for (const Landmark& other : landmarks) {
      const auto others = seen.find(other.id);
      if (other.id == landmark.id || others == seen.end() || !standInEachOther(landmark, other)) continue;
      if (other.id < landmark.id && others->second.back().t >= since_t) continue;  // asked already
      const auto [first, second] = std::minmax(landmark.id, other.id);
      if (const auto change = changeOfPlace(ofOneObject(own->second, others->second))) pairs.push_back({first, second, *change});
    }
  }
  alone.insert(alone.end(), pairs.begin(), pairs.end());
  return alone;
}

bool raysAgree(const Landmark& landmark, const ChangeOfPlace& change, const PosedViews& views) {
  Pose3 then = landmark.worldFromObject(), now = then;
  then.translation().head<2>() = change.before, now.translation().head<2>() = change.after;
  const PosedViews earlier = views.between(change.since_t, change.last_t), later = views.between(change.first_t, kEver_s);
  return freeShare(onlyHere(landmark.shape, then, now), earlier, later) >= kLeastChanged &&
         freeShare(onlyHere(landmark.shape, now, then), later, earlier) >= kLeastChanged;
}

// Single points at the edges of what stands there still seem free from elsewhere.
double emptiedSince(double last_sighting_t, const Landmark& landmark, const PosedViews& views) {
  constexpr double kLater_s = 30;
  const Pose3 world_from_object = landmark.worldFromObject();
  std::vector<Eigen::Vector3d> points = volumePoints(landmark.shape);
  for (Eigen::Vector3d& p : points) p = world_from_object * p;
  const double free = freeShare(points, views.between(-kEver_s, last_sighting_t), views.between(last_sighting_t + kLater_s, kEver_s));
  return std::max(0.0, (free - kStillThere) / (1 - kStillThere));
}

}  // namespace roomgraph
