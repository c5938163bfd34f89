// SPDX-License-Identifier: BSD-3-Clause
// Giving up of keyframes that repeat older ones.
#include "place_recognition.h"
#include "tracker.h"

namespace roomgraph::tracking {
namespace {

constexpr int kRecentKeyframes = 40;  // the map around the camera, as a rule
constexpr int kExaminedAtOnce = 2;    // more than come, so that the number goes down
constexpr double kSameView_m = 0.4, kSameView_rad = 0.4;
constexpr double kLeastShown = 0.2;   // of what has depth; less is a place that has changed

bool isSameView(const Pose3& between) {
  return between.translation().norm() / kSameView_m + rotationAngle(between) / kSameView_rad < 1;
}

}  // namespace

void Tracker::giveUpRepeated() {
  const int end = static_cast<int>(map_.keyframes.size()) - kRecentKeyframes;
  for (int tried = 0; tried < kExaminedAtOnce; ++tried) {
    if (keyframesHeld() <= parameters_.keyframes_kept || examined_ >= end) return;
    if (const auto older = olderSameView(examined_)) {
      map_.giveUp(examined_, *older);
      ++given_up_;
    }
    ++examined_;
  }
}

std::optional<int> Tracker::olderSameView(int index) const {
  const double least_shown = kLeastShown * static_cast<double>(map_.keyframe(index).features.withDepth());
  for (const int older : loopCandidates(map_, index, parameters_)) {
    const auto seen = seenFrom(older, index);
    if (seen && seen->inliers >= least_shown && isSameView(seen->camera_from_world)) return older;
  }
  return std::nullopt;
}

}  // namespace roomgraph::tracking
