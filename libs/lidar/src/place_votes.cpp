// SPDX-License-Identifier: BSD-3-Clause
// Votes for the place of a segment, compared where the latest scan would be.
#include "place_votes.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace roomgraph {
namespace {

constexpr std::size_t kAgreeingScans = 8;
constexpr double kAgreeingSpan_m = 3, kRemembered_m = 15;  // of path
constexpr std::size_t kPerDissent = 4;  // scans that agree, for each that does not
constexpr double kSpread_m = 0.25, kSpread_rad = 0.08, kSpreadPerPath = 0.02;  // m per m, a tenth of it in rad

}  // namespace

std::vector<Closure> PlaceVotes::add(const Closure& closure, int piece, const std::vector<WayPoint>& way, const PlaceOf& placeOf) {
  const auto at = [&](int scan) -> const WayPoint& { return way[static_cast<std::size_t>(scan)]; };
  const WayPoint& here = at(closure.b);
  std::erase_if(votes_, [&](const Vote& vote) {
    return at(vote.closure.b).segment != here.segment || here.path_m - at(vote.closure.b).path_m > kRemembered_m;
  });
  const auto world_from_a = placeOf(closure.a);
  if (!world_from_a) return {};
  votes_.push_back({closure, piece});

  const Pose2 world_from_here = *world_from_a * closure.a_from_b;
  std::vector<Closure> agreeing;
  std::set<int> scans, others;
  double first_m = here.path_m;
  for (const Vote& vote : votes_) {
    const auto place = placeOf(vote.closure.a);
    if (vote.piece != piece || !place) continue;
    const WayPoint& there = at(vote.closure.b);
    const Pose2 by_vote = *place * vote.closure.a_from_b * (there.odom_from_robot.inverse() * here.odom_from_robot);
    const Pose2 error = world_from_here.inverse() * by_vote;
    const double more = kSpreadPerPath * (here.path_m - there.path_m);
    if (std::hypot(error.x, error.y) > kSpread_m + more || std::abs(error.yaw) > kSpread_rad + 0.1 * more) {
      others.insert(vote.closure.b);
      continue;
    }
    agreeing.push_back(vote.closure);
    scans.insert(vote.closure.b);
    first_m = std::min(first_m, there.path_m);
  }
  const bool believed =
      scans.size() >= kAgreeingScans && here.path_m - first_m >= kAgreeingSpan_m && kPerDissent * others.size() <= scans.size();
  return believed ? agreeing : std::vector<Closure>();
}

void PlaceVotes::forget(int piece) {
  std::erase_if(votes_, [piece](const Vote& vote) { return vote.piece == piece; });
}

}  // namespace roomgraph
