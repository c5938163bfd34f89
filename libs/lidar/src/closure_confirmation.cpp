// SPDX-License-Identifier: BSD-3-Clause
// Consistency of two closures over the path between them, and the group that confirms a closure.
#include "closure_confirmation.h"

#include <algorithm>
#include <cmath>

namespace roomgraph {
namespace {

const WayPoint& at(const std::vector<WayPoint>& way, int i) { return way[static_cast<std::size_t>(i)]; }

bool isWithin(const WayPoint& first, const WayPoint& second, double reach_m) {
  return first.segment == second.segment && std::abs(first.path_m - second.path_m) <= reach_m;
}

// Whether the odometry tells how the two should lie to each other.
bool areComparable(const Closure& first, const Closure& second, const std::vector<WayPoint>& way, const ConfirmationRule& rule) {
  return isWithin(at(way, first.a), at(way, second.a), rule.reach_m) && isWithin(at(way, first.b), at(way, second.b), rule.reach_m);
}

}  // namespace

bool agree(const Closure& first, const Closure& second, const std::vector<WayPoint>& way,
           const ConfirmationRule& rule) {
  if (!areComparable(first, second, way, rule)) return false;
  const WayPoint &a1 = at(way, first.a), &b1 = at(way, first.b), &a2 = at(way, second.a), &b2 = at(way, second.b);
  const double way_a = std::abs(a1.path_m - a2.path_m), way_b = std::abs(b1.path_m - b2.path_m);
  const Pose2 a1_from_a2 = a1.odom_from_robot.inverse() * a2.odom_from_robot;
  const Pose2 b2_from_b1 = b2.odom_from_robot.inverse() * b1.odom_from_robot;
  const Pose2 error = first.a_from_b.inverse() * (a1_from_a2 * second.a_from_b * b2_from_b1);
  const double more = rule.tolerance_per_m * (way_a + way_b);
  return std::hypot(error.x, error.y) <= rule.tolerance_m + more &&
         std::abs(error.yaw) <= rule.tolerance_rad + 0.1 * more;
}

std::vector<Closure> ClosureConfirmation::add(const Closure& closure, const std::vector<WayPoint>& way,
                                              const ConfirmationRule& rule, const HaveRival& haveRival) {
  const auto path = [&](const Closure& c) { return at(way, c.b).path_m; };
  std::erase_if(waiting_, [&](const Closure& old) { return path(closure) - path(old) > rule.reach_m; });
  std::vector<Closure> group{closure};
  double low = path(closure), high = low;
  int scans = 1;
  for (const Closure& old : waiting_) {
    if (!agree(closure, old, way, rule)) continue;
    const bool other_scan =
        std::none_of(group.begin(), group.end(), [&](const Closure& c) { return c.b == old.b; });
    scans += other_scan;
    low = std::min(low, path(old));
    high = std::max(high, path(old));
    group.push_back(old);
  }
  if (scans < rule.agreeing || high - low < rule.travelled_m) {
    waiting_.push_back(closure);
    return {};
  }
  if (haveRival && haveRival(group)) return {};
  std::erase_if(waiting_, [&](const Closure& old) {
    return std::any_of(group.begin(), group.end(),
                       [&](const Closure& c) { return c.a == old.a && c.b == old.b; });
  });
  return group;
}

void ClosureConfirmation::accept(const Closure& closure, const std::vector<WayPoint>& way, const ConfirmationRule& rule) {
  std::erase_if(accepted_, [&](const Closure& old) { return !isWithin(at(way, old.b), at(way, closure.b), rule.reach_m); });
  accepted_.push_back(closure);
}

bool ClosureConfirmation::contradicts(const Closure& closure, const std::vector<WayPoint>& way, const ConfirmationRule& rule) const {
  int agreeing = 0, others = 0;
  for (const Closure& old : accepted_)
    if (areComparable(old, closure, way, rule)) ++(agree(old, closure, way, rule) ? agreeing : others);
  return others > agreeing;
}

}  // namespace roomgraph
