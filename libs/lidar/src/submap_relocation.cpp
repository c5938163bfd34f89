// SPDX-License-Identifier: BSD-3-Clause
// Search for the place of a segment that nothing ties to older ones, in whole submaps.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "submap_loop_closer.h"

namespace roomgraph {
namespace {

constexpr std::size_t kFruitless = 50;  // searches, after which only every second scan is looked for, and so on: it may be a place that was never seen

}  // namespace

int SubmapLoopCloser::pieceOf(int scan) const {
  const auto begun = std::upper_bound(adrift_.begin(), adrift_.end(), scan) - adrift_.begin();
  return begun == 0 ? 0 : tied_to_[static_cast<std::size_t>(begun - 1)];
}

void SubmapLoopCloser::beginPiece(int scan) {
  adrift_.push_back(scan);
  tied_to_.push_back(static_cast<int>(adrift_.size()));
  searched_whole_ = found_whole_ = 0;
}

void SubmapLoopCloser::tie(const Closure& closure) {
  const int a = pieceOf(closure.a), b = pieceOf(closure.b);
  if (a == b) return;
  for (int& piece : tied_to_)
    if (piece == std::max(a, b)) piece = std::min(a, b);
  votes_.forget(a);
  votes_.forget(b);
}

std::vector<std::size_t> SubmapLoopCloser::untiedSubmaps(int scan) const {
  std::vector<std::size_t> out;
  const int piece = pieceOf(scan);
  for (std::size_t s = 0; s < submaps_.size(); ++s)
    if (submaps_[s].map && submaps_[s].last < scan && pieceOf(submaps_[s].last) != piece) out.push_back(s);
  return out;
}

std::vector<Closure> SubmapLoopCloser::vote(const Closure& closure, const Probe& b, PlacesInWorld& world) {
  const int piece = pieceOf(closure.a);
  const auto placeOf = [&](int scan) { return world.of(scan); };
  std::vector<Closure> believed = votes_.add(closure, piece, way_, placeOf);
  if (believed.empty()) return {};
  if (hasRival(closure, b, world)) {
    votes_.forget(piece);  // from here on, where the robot may see what tells the two apart
    return {};
  }
  tie(closure);
  return believed;
}

// Rooms of one shape: what is believed of one must not hold in another.
bool SubmapLoopCloser::hasRival(const Closure& closure, const Probe& b, PlacesInWorld& world) {
  constexpr double kOther_m = 1, kOther_rad = 0.3;
  const int piece = pieceOf(closure.a);
  const auto world_from_a = world.of(closure.a);
  if (!world_from_a) return true;
  const Pose2 here = *world_from_a * closure.a_from_b;
  for (const std::size_t submap : untiedSubmaps(b.scan)) {
    if (pieceOf(submaps_[submap].last) != piece) continue;
    const auto other = matchAnywhere(submap, b);
    const auto place = other ? world.of(other->a) : std::nullopt;
    if (!place) continue;
    const Pose2 error = here.inverse() * (*place * other->a_from_b);
    if (std::hypot(error.x, error.y) > kOther_m || std::abs(error.yaw) > kOther_rad) return true;
  }
  return false;
}

std::vector<std::size_t> SubmapLoopCloser::nextUntied(const Probe& b) {
  std::vector<std::size_t> out;
  const auto pause = static_cast<int>(1 + (found_whole_ > 0 ? 0 : searched_whole_ / kFruitless));
  if (static_cast<int>(b.points.size()) < submap_settings_.min_points || b.scan % pause != 0) return out;
  const std::vector<std::size_t> untied = untiedSubmaps(b.scan);
  while (out.size() < std::min(untied.size(), static_cast<std::size_t>(max_candidates_))) out.push_back(untied[turn_++ % untied.size()]);
  return out;
}

std::vector<Closure> SubmapLoopCloser::locate(const Probe& b, const std::vector<std::size_t>& submaps, PlacesInWorld& world) {
  for (const std::size_t submap : submaps) {
    ++searched_whole_;
    const auto closure = matchAnywhere(submap, b);
    if (!closure) continue;
    ++found_whole_;
    auto believed = vote(*closure, b, world);
    if (!believed.empty()) return believed;
  }
  return {};
}

std::optional<Closure> SubmapLoopCloser::matchAnywhere(std::size_t number, const Probe& b) {
  const KeptSubmap& submap = submaps_[number];
  const ProbabilityGrid& grid = submap.map->grid;
  const ProbabilityGrid::Block& seen = grid.storedBlock();
  const Eigen::Vector2d middle = grid.corner() + grid.cellSize() * Eigen::Vector2d(seen.x0 + seen.width / 2.0, seen.y0 + seen.height / 2.0);
  const SearchWindow everywhere{grid.cellSize() * std::max(seen.width, seen.height) / 2, std::numbers::pi, 0, 0, min_search_score_};
  const auto found = fit(number, b, {middle.x(), middle.y(), 0}, everywhere, true);
  if (!found) return std::nullopt;
  int nearest = submap.first;
  double least_m = std::numeric_limits<double>::infinity();
  for (int a = submap.first; a <= submap.last; ++a) {
    const Pose2& there = way_[static_cast<std::size_t>(a)].odom_from_robot;
    const Pose2& here = found->refined.grid_from_scan;
    const double distance_m = std::hypot(there.x - here.x, there.y - here.y);
    if (distance_m < least_m) nearest = a, least_m = distance_m;
  }
  return closureOf(nearest, b.scan, *found, least_m);
}

}  // namespace roomgraph
