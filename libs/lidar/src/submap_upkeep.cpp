// SPDX-License-Identifier: BSD-3-Clause
// Giving up of submaps that repeat older ones.
#include <algorithm>
#include <cmath>

#include "submap_loop_closer.h"

namespace roomgraph {
namespace {

constexpr std::size_t kRecentSubmaps = 6;  // may yet be closed with what comes
constexpr double kSamePlace_m = 0.6, kSameDirection_rad = 0.6;
constexpr double kLeastRepeated = 0.9;  // share of its scans
constexpr double kSpareWay_m = 0.5;     // by which a way may seem longer once a scan on it is given up: the graph stays sparse
constexpr double kTied_m = 12;          // of path over closures, within which places are surely told apart

bool isSameView(const Pose2& a, const Pose2& b) {
  return std::hypot(a.x - b.x, a.y - b.y) < kSamePlace_m && std::abs(wrapAngle(a.yaw - b.yaw)) < kSameDirection_rad;
}

}  // namespace

void SubmapLoopCloser::giveUpRepeated(PlacesInWorld& world) {
  if (submapsHeld() <= submaps_kept_ || examined_ + kRecentSubmaps >= submaps_.size()) return;
  KeptSubmap& submap = submaps_[examined_++];
  if (isRepeated(submap, world)) giveUp(submap);
}

// Of submaps that end before this scan; they have been looked at, and stay.
std::vector<int> SubmapLoopCloser::scansHeldBefore(int scan) const {
  std::vector<int> out;
  for (const KeptSubmap& submap : submaps_)
    if (submap.map && submap.last < scan)
      for (int held = submap.first; held <= submap.last; ++held) out.push_back(held);
  return out;
}

bool SubmapLoopCloser::isRepeated(const KeptSubmap& submap, PlacesInWorld& world) const {
  const auto reached = graph_.reachedFrom((submap.first + submap.last) / 2);
  std::vector<Pose2> tied;
  for (const int older : scansHeldBefore(submap.first))
    if (reached[older].length_m < kTied_m)
      if (const auto& place = world.of(older)) tied.push_back(*place);
  int repeated = 0;
  for (int scan = submap.first; scan <= submap.last; ++scan)
    if (const auto& here = world.of(scan))
      repeated += std::any_of(tied.begin(), tied.end(), [&](const Pose2& there) { return isSameView(there, *here); });
  return repeated >= kLeastRepeated * (submap.last - submap.first + 1);
}

std::optional<SubmapLoopCloser::KeptScan> SubmapLoopCloser::keptFor(int scan) const {
  if (const auto it = stands_for_.find(scan); it != stands_for_.end()) return it->second;
  std::optional<KeptScan> best;
  double least_m = kTied_m;
  const auto reached = graph_.reachedFrom(scan);
  for (const KeptSubmap& submap : submaps_) {
    if (!submap.map) continue;
    for (int held = submap.first; held <= submap.last; ++held) {
      const ClosureGraph::Reached& way = reached[held];
      if (way.length_m < least_m) best = KeptScan{held, way.start_from_node.inverse()}, least_m = way.length_m;
    }
  }
  return best;
}

void SubmapLoopCloser::giveUp(KeptSubmap& submap) {
  submap.map.reset();
  ++given_up_;
  std::vector<int> scans;
  for (int scan = submap.first; scan <= submap.last; ++scan) {
    const bool waits = !waiting_.empty() && scan >= waiting_.front();
    const bool needed = waits || std::any_of(submaps_.begin(), submaps_.end(), [scan](const KeptSubmap& other) {
      return other.map && other.first <= scan && scan <= other.last;
    });
    if (!needed) scans.push_back(scan);
  }
  {
    const ClosureGraph::Paths nearest = graph_.reachedFromAny(scansHeldBefore(submap.first));
    for (const int scan : scans)
      if (nearest[scan].length_m < kTied_m) stands_for_[scan] = {nearest[scan].start, nearest[scan].start_from_node};
  }
  for (const int scan : scans) {
    graph_.remove(scan, kSpareWay_m);
    Scan& empty = scans_[static_cast<std::size_t>(scan)];
    empty.ranges_m = {}, empty.valid = {};
    empty.ranges_m.shrink_to_fit(), empty.valid.shrink_to_fit();
  }
}

}  // namespace roomgraph
