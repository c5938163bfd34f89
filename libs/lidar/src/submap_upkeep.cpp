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
constexpr double kTied_m = 12;          // of path over closures, within which places are surely told apart

bool isSameView(const Pose2& a, const Pose2& b) {
  return std::hypot(a.x - b.x, a.y - b.y) < kSamePlace_m && std::abs(wrapAngle(a.yaw - b.yaw)) < kSameDirection_rad;
}

}  // namespace

void SubmapLoopCloser::giveUpRepeated(const std::vector<std::optional<Pose2>>& world) {
  if (submapsHeld() <= submaps_kept_ || examined_ + kRecentSubmaps >= submaps_.size()) return;
  KeptSubmap& submap = submaps_[examined_++];
  if (isRepeated(submap, world)) giveUp(submap);
}

bool SubmapLoopCloser::isRepeated(const KeptSubmap& submap, const std::vector<std::optional<Pose2>>& world) const {
  const auto reached = graph_.reachedFrom((submap.first + submap.last) / 2);
  const auto repeats = [&](int older, int scan) {
    const auto &there = world[static_cast<std::size_t>(older)], &here = world[static_cast<std::size_t>(scan)];
    return there && here && reached[static_cast<std::size_t>(older)].length_m < kTied_m && isSameView(*there, *here);
  };
  int repeated = 0;
  for (int scan = submap.first; scan <= submap.last; ++scan)
    repeated += std::any_of(submaps_.begin(), submaps_.end(), [&](const KeptSubmap& other) {
      if (!other.map || other.last >= submap.first) return false;
      for (int older = other.first; older <= other.last; ++older)
        if (repeats(older, scan)) return true;
      return false;
    });
  return repeated >= kLeastRepeated * (submap.last - submap.first + 1);
}

std::optional<SubmapLoopCloser::KeptScan> SubmapLoopCloser::keptFor(int scan) const {
  std::optional<KeptScan> best;
  double least_m = kTied_m;
  const auto reached = graph_.reachedFrom(scan);
  for (const KeptSubmap& submap : submaps_) {
    if (!submap.map) continue;
    for (int held = submap.first; held <= submap.last; ++held) {
      const ClosureGraph::Reached& way = reached[static_cast<std::size_t>(held)];
      if (way.length_m < least_m) best = KeptScan{held, way.start_from_node.inverse()}, least_m = way.length_m;
    }
  }
  return best;
}

void SubmapLoopCloser::giveUp(KeptSubmap& submap) {
  submap.map.reset();
  ++given_up_;
  for (int scan = submap.first; scan <= submap.last; ++scan) {
    const bool waits = !waiting_.empty() && scan >= waiting_.front();
    const bool needed = waits || std::any_of(submaps_.begin(), submaps_.end(), [scan](const KeptSubmap& other) {
      return other.map && other.first <= scan && scan <= other.last;
    });
    if (needed) continue;
    Scan& empty = scans_[static_cast<std::size_t>(scan)];
    empty.ranges_m = {}, empty.valid = {};
    empty.ranges_m.shrink_to_fit(), empty.valid.shrink_to_fit();
  }
}

}  // namespace roomgraph
