// SPDX-License-Identifier: BSD-3-Clause
// When a closure is believed: what others say of it, and whether another place fits as well.
#include <algorithm>
#include <cmath>

#include "submap_loop_closer.h"

namespace roomgraph {
namespace {

constexpr double kOfWindow = 0.5;     // of the half width of a search its scans must span that agree
constexpr double kOfDrift = 2;        // of the drift that is assumed may be
constexpr double kFarthestRival_m = 12;

}  // namespace

std::vector<Closure> SubmapLoopCloser::believed(const Closure& closure, const Probe& b, PlacesInWorld& world) {
  if (pieceOf(closure.a) != pieceOf(closure.b)) return vote(closure, b, world);
  const ConfirmationRule rule = ruleFor(closure.path_m);
  const bool is_far = closure.path_m > trusted_path_m_;
  if (!is_far && !(closure.in_corridor && confirmation_.contradicts(closure, way_, rule))) return {closure};
  return confirmation_.add(closure, way_, rule, [&](const auto& agreeing) { return is_far && fitElsewhere(agreeing, b, world); });
}

// Where the place may be anywhere on metres, doors of a corridor look alike for a metre. After a loss no path tells of drift.
ConfirmationRule SubmapLoopCloser::ruleFor(double path_m) const {
  ConfirmationRule rule{.agreeing = agreeing_closures_, .travelled_m = agreeing_path_m_};
  if (std::isfinite(path_m)) rule.travelled_m = std::max(rule.travelled_m, kOfWindow * windowFor(path_m).linear_m);
  return rule;
}

int SubmapLoopCloser::nearestScanOf(const KeptSubmap& submap, int b, double reach_m, PlacesInWorld& world) const {
  const auto path = [&](int scan) { return way_[static_cast<std::size_t>(scan)].path_m; };
  if (!submap.map || b <= submap.last || path(b) - path(submap.last) < min_path_m_) return -1;
  const std::optional<Pose2>& here = world.of(b);
  int nearest = -1;
  for (int a = submap.first; here && a <= submap.last; ++a) {
    const std::optional<Pose2>& there = world.of(a);
    if (!there) continue;
    const double distance_m = std::hypot(there->x - here->x, there->y - here->y);
    if (distance_m < reach_m) nearest = a, reach_m = distance_m;
  }
  return nearest;
}

bool SubmapLoopCloser::fitElsewhere(const std::vector<Closure>& agreeing, const Probe& b, PlacesInWorld& world) {
  const Closure& closure = agreeing.front();
  const std::optional<Pose2>&world_from_a = world.of(closure.a), &world_from_b = world.of(b.scan);
  if (!world_from_a || !world_from_b) return false;
  const double reach_m = std::min(kFarthestRival_m, window_m_ + kOfDrift * drift_per_m_ * closure.path_m);
  const SearchWindow window{reach_m, window_rad_, 0, 0, ambiguity_ratio_ * closure.score};
  for (std::size_t s = 0; s < submaps_.size(); ++s) {
    const int nearest = nearestScanOf(submaps_[s], b.scan, near_m_ + reach_m, world);
    if (nearest < 0) continue;
    const Pose2 map_from_world = way_[static_cast<std::size_t>(nearest)].odom_from_robot * world.of(nearest)->inverse();
    const ExcludedPose same = around(map_from_world * (*world_from_a * closure.a_from_b));
    const ScorePyramid& pyramid = pyramids_.of(s, submaps_[s].map->grid);
    Pose2 expected = map_from_world * *world_from_b;
    expected.yaw = same.pose.yaw;  // the drift turns both places alike
    const auto rival = correlativeSearch(pyramid, b.points, expected, window, same);
    if (rival && goAlong(agreeing, s, rival->grid_from_scan)) return true;
  }
  return false;
}

// A likeness of one view is soon over.
bool SubmapLoopCloser::goAlong(const std::vector<Closure>& agreeing, std::size_t submap, const Pose2& grid_from_first) {
  const ScorePyramid& pyramid = pyramids_.of(submap, submaps_[submap].map->grid);
  const auto placeOf = [&](const Closure& c) -> const Pose2& { return way_[static_cast<std::size_t>(c.b)].odom_from_robot; };
  return std::all_of(agreeing.begin() + 1, agreeing.end(), [&](const Closure& c) {
    const Pose2 expected = grid_from_first * (placeOf(agreeing.front()).inverse() * placeOf(c));
    const SearchWindow window{window_m_, window_rad_, 0, 0, ambiguity_ratio_ * c.score};
    return correlativeSearch(pyramid, probeOf(c.b).points, expected, window).has_value();
  });
}

}  // namespace roomgraph
