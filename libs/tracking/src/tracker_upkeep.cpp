// SPDX-License-Identifier: BSD-3-Clause
// Giving up of keyframes that repeat older ones.
#include <algorithm>

#include "place_recognition.h"
#include "tracker.h"

namespace roomgraph::tracking {
namespace {

constexpr int kRecentKeyframes = 40;           // the map around the camera, as a rule
constexpr int kExaminedAtOnce = 2;             // more than come, so that the number goes down
constexpr double kSameView_m = 0.4, kSameView_rad = 0.4;

bool isSameView(const Pose3& between) {
  return between.translation().norm() / kSameView_m + rotationAngle(between) / kSameView_rad < 1;
}

}  // namespace

void Tracker::giveUpRepeated() {
  const int end = static_cast<int>(map_.keyframes.size()) - kRecentKeyframes;
  const auto around_camera = map_.covisible(last_points_);
  const auto isInUse = [&](int index) {
    return std::any_of(around_camera.begin(), around_camera.end(),
                       [&](const auto& entry) { return entry.second == index; });
  };
  for (int tried = 0; tried < kExaminedAtOnce; ++tried) {
    if (keyframesHeld() <= parameters_.keyframes_kept || examined_ >= end || isInUse(examined_)) return;
    given_up_ += giveUpIfRepeated(examined_++);
  }
}

bool Tracker::giveUpIfRepeated(int index) {
  const Keyframe& keyframe = map_.keyframe(index);
  const auto neighbours = map_.covisible(keyframe.points);
  const auto holder = std::find_if(neighbours.begin(), neighbours.end(), [&](const auto& entry) {
    return entry.second != index && map_.keyframe(entry.second).segment == keyframe.segment;
  });
  if (holder == neighbours.end()) return false;
  const auto older = loopCandidates(map_, index, parameters_);
  const bool repeated = std::any_of(older.begin(), older.end(), [&](int other) {
    const auto found = recognize(map_, other, keyframe.features, keyframe.camera, parameters_);
    if (found.solution.inliers < parameters_.loop_min_inliers) return false;
    const Pose3 there = found.solution.camera_from_world.inverse();
    return isSameView(there) && plausible(other, around(index), there);
  });
  if (!repeated) return false;
  // The frames that it held move along with the keyframe that shares most with it.
  const Pose3 holder_from_keyframe =
      map_.keyframe(holder->second).odom_from_camera.inverse() * keyframe.odom_from_camera;
  for (Record& record : records_)
    if (record.keyframe == index) {
      record.keyframe = holder->second;
      record.keyframe_from_camera = normalized(holder_from_keyframe * record.keyframe_from_camera);
    }
  map_.giveUp(index);
  return true;
}

}  // namespace roomgraph::tracking
