// SPDX-License-Identifier: BSD-3-Clause
// Loop closures of the tracker: older keyframes that show what a keyframe shows, and whether another place does, too.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "place_recognition.h"
#include "roomgraph/geometry/covariance.h"
#include "tracker.h"

namespace roomgraph::tracking {
namespace {

constexpr int kLoopPause = 3;           // keyframes between two loop closures
constexpr double kVerifyHorizon_s = 3;  // keyframes this near in time show the proposed place
constexpr int kVerifyKeyframes = 2;
// Keyframes tracked without a break as far from a place know how they lie to it better than that, and do not show the same of it.
constexpr int kRivalKeyframes = 40;
constexpr std::array kRivalDistances_m = {1.0, 2.0, 4.0, 10.0};  // from one to the next the keyframe that looks most alike
constexpr double kRivalElsewhere_m = 0.5;
constexpr double kRivalInliers = 0.5;  // as a share of those of what it rivals

}  // namespace

RelativePose Tracker::loopOf(int keyframe, double t, const Pose3& keyframe_from_camera,
                             const Matrix6d& covariance) const {
  RelativePose closure;
  closure.t_a = map_.keyframe(keyframe).t;
  closure.t_b = t;
  closure.a_from_b = keyframe_from_camera;
  closure.covariance =
      parameters_.covariance_scale * rotateCovariance(covariance, keyframe_from_camera.linear()) +
      floorCovariance(parameters_.min_loop_sigma_m, parameters_.min_loop_sigma_rad);
  closure.source = "tracking";
  return closure;
}

std::optional<PoseSolution> Tracker::seenFrom(int other, int index) const {
  const Keyframe& keyframe = map_.keyframe(index);
  const PoseSolution found = recognize(map_, other, keyframe.features, keyframe.camera, parameters_).solution;
  if (found.inliers < parameters_.loop_min_inliers) return std::nullopt;
  const Pose3 other_from_keyframe = found.camera_from_world.inverse();
  if (offFloor(other_from_keyframe) || !plausible(other, around(index), other_from_keyframe)) return std::nullopt;
  return found;
}

std::vector<int> Tracker::similarBeside(int place, const Sighting& view) const {
  const Keyframe& middle = map_.keyframe(place);
  constexpr std::size_t kRings = kRivalDistances_m.size() - 1;
  std::array<std::pair<double, int>, kRings> most_alike;
  most_alike.fill({-std::numeric_limits<double>::infinity(), -1});
  for (int i = std::max(0, place - kRivalKeyframes); i <= place + kRivalKeyframes && map_.has(i); ++i) {
    const Keyframe& beside = map_.keyframe(i);
    if (beside.isGivenUp() || beside.segment != middle.segment) continue;
    const double apart_m = (middle.odom_from_camera.translation() - beside.odom_from_camera.translation()).norm();
    const auto beyond = std::upper_bound(kRivalDistances_m.begin(), kRivalDistances_m.end(), apart_m);
    if (beyond == kRivalDistances_m.begin() || beyond == kRivalDistances_m.end()) continue;
    auto& best = most_alike[static_cast<std::size_t>(beyond - kRivalDistances_m.begin() - 1)];
    best = std::max(best, std::pair<double, int>(similarity(beside.thumbnail, view.thumbnail), i));
  }
  std::vector<int> out;
  for (const auto& [similar, index] : most_alike)
    if (index >= 0) out.push_back(index);
  return out;
}

double Tracker::nearestRival_m(int place, const Sighting& view, const Pose3& place_from_view, int inliers) const {
  const double least = std::max<double>(parameters_.min_inliers, kRivalInliers * inliers);
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const int beside : similarBeside(place, view)) {
    const PoseSolution found = recognize(map_, beside, view.features, view.camera, parameters_).solution;
    if (found.inliers < least) continue;
    const Pose3 place_from_beside = map_.keyframe(place).odom_from_camera.inverse() * map_.keyframe(beside).odom_from_camera;
    const Pose3 rival = place_from_beside * found.camera_from_world.inverse();
    const double apart_m = (rival.translation() - place_from_view.translation()).norm();
    if (apart_m > kRivalElsewhere_m) nearest_m = std::min(nearest_m, apart_m);
  }
  return nearest_m;
}

RelativePose Tracker::loopBetween(int a, int b, const PoseSolution& seen) const {
  const Keyframe& view = map_.keyframe(b);
  const Pose3 a_from_b = seen.camera_from_world.inverse();
  const Sighting sighting{view.features, view.camera, view.thumbnail};
  RelativePose closure = loopOf(a, view.t, a_from_b, seen.covariance);
  closure.rival_m = std::min(nearestRival_m(a, sighting, a_from_b, seen.inliers), nearestRival_m(b, sighting, Pose3::Identity(), seen.inliers));
  return closure;
}

void Tracker::closeLoops(int index) {
  if (index - last_loop_ < kLoopPause) return;
  for (const int candidate : loopCandidates(map_, index, parameters_)) {
    const auto seen = seenFrom(candidate, index);
    if (!seen) continue;
    closures_.push_back(loopBetween(candidate, index, *seen));
    last_loop_ = index;
    return;
  }
}

std::vector<int> Tracker::keyframesNear(double t) const {
  std::vector<std::pair<double, int>> near;
  for (int i = 0; i < static_cast<int>(map_.keyframes.size()); ++i)
    if (const double apart = std::abs(map_.keyframe(i).t - t); apart < kVerifyHorizon_s)
      near.emplace_back(apart, i);
  std::sort(near.begin(), near.end());
  std::vector<int> out;
  for (const auto& [apart, index] : near) {
    const int held = map_.keyframe(index).isGivenUp() ? map_.keyframe(index).shown_by : index;
    if (static_cast<int>(out.size()) < kVerifyKeyframes && std::find(out.begin(), out.end(), held) == out.end())
      out.push_back(held);
  }
  return out;
}

std::optional<RelativePose> Tracker::verifyLoop(const RelativePose& proposed) const {
  for (const int b : keyframesNear(proposed.t_b)) {
    if (std::abs(map_.keyframe(b).t - proposed.t_b) > kVerifyHorizon_s) continue;  // what shows the same says nothing of then
    for (const int a : keyframesNear(proposed.t_a)) {
      if (a == b) continue;
      if (const auto seen = seenFrom(a, b)) return loopBetween(a, b, *seen);
    }
  }
  return std::nullopt;
}

}  // namespace roomgraph::tracking
