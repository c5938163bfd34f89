// SPDX-License-Identifier: BSD-3-Clause
// Pose of a frame from the last frame's points, a keyframe, relocalisation or the local map.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>

#include "place_recognition.h"
#include "tracker.h"

namespace roomgraph::tracking {
namespace {

constexpr int kBeside = 5;               // keyframes before and after that show the place
constexpr int kFarthestBeside = 25;      // of them, given up ones in between counted
constexpr double kLeastAgreement = 0.9;  // of two views of one place
constexpr double kMostRise_m = 0.15, kMostTilt_rad = 0.1;  // of a robot, from where it saw a place before: its floor is even
constexpr double kFar_m = 0.15, kFar_rad = 0.15;
constexpr double kUnseen_m_s = 1, kUnseen_rad_s = 3;  // dead reckoning errs by no more, unless the camera is carried away

// More than dead reckoning errs by since the last view.
bool isFar(const Pose3& difference) {
  return difference.translation().norm() > kFar_m || rotationAngle(difference) > kFar_rad;
}

void assign(std::vector<std::int64_t>& points, const std::vector<PointMatch>& matches) {
  for (const auto& match : matches) points[static_cast<std::size_t>(match.feature)] = match.point;
}

}  // namespace

PoseProblem Tracker::problemOf(const View& view, std::vector<std::size_t>& used) const {
  PoseProblem problem{view.frame->camera, {}, {}};
  for (std::size_t i = 0; i < view.points.size(); ++i) {
    if (view.points[i] < 0) continue;
    used.push_back(i);
    problem.points.push_back(map_.point(view.points[i]).position);
    problem.observations.push_back(makeObservation(view.features.pixel(i), view.features.places[i].octave,
                                                   view.features.depth[i], parameters_));
  }
  return problem;
}

bool Tracker::solve(View& view, int min_inliers, bool start_is_good) const {
  std::vector<std::size_t> used;
  const PoseProblem problem = problemOf(view, used);
  view.matches = static_cast<int>(used.size());
  if (view.matches < min_inliers) return false;
  view.solution = refinePose(problem, view.odom_from_camera.inverse(), start_is_good);
  if (view.solution.inliers < min_inliers) return false;
  for (std::size_t j = 0; j < used.size(); ++j)
    if (!view.solution.inlier[j]) view.points[used[j]] = -1;
  view.odom_from_camera = normalized(view.solution.camera_from_world.inverse());
  return true;
}

bool Tracker::trackLastPoints(View& view, const Pose3& predicted, double radius_px) {
  view.points.assign(view.features.size(), -1);
  view.odom_from_camera = predicted;
  const Pose3 camera_from_odom = predicted.inverse();
  const ProjectionSearch search{map_, view.frame->camera, camera_from_odom, radius_px};
  assign(view.points, search.match(last_points_, view.features, view.points, parameters_));
  return solveWithMovers(view, predicted);
}

bool Tracker::trackKeyframe(View& view, int keyframe, int min_inliers) const {
  const auto found = recognize(map_, keyframe, view.features, view.frame->camera, parameters_);
  if (found.solution.inliers < min_inliers) return false;
  view.odom_from_camera =
      map_.keyframe(keyframe).odom_from_camera * found.solution.camera_from_world.inverse();
  if (!withinReach(view)) return false;
  view.points.assign(view.features.size(), -1);
  assign(view.points, found.known_points);
  return true;
}

bool Tracker::withinReach(const View& view) const {
  if (carried_) return true;
  const double seconds = view.frame->t - placed_.t;
  const Pose3 off = (lastPose() * dead_reckoned_).inverse() * view.odom_from_camera;
  return off.translation().norm() < kFar_m + kUnseen_m_s * seconds && rotationAngle(off) < kFar_rad + kUnseen_rad_s * seconds;
}

bool Tracker::relocalise(View& view) {
  const auto candidates = mostSimilar(map_, makeThumbnail(view.gray), static_cast<int>(map_.keyframes.size()),
                                      parameters_.relocalisation_candidates);
  const DepthSketch sketch = sketchDepth(*view.frame, view.prior->dynamic_regions);
  return std::any_of(candidates.begin(), candidates.end(), [&](int candidate) {
    if (!trackKeyframe(view, candidate, parameters_.relocalisation_min_inliers)) return false;
    const Pose3 keyframe_from_view = map_.keyframe(candidate).odom_from_camera.inverse() * view.odom_from_camera;
    return !offFloor(keyframe_from_view) && plausible(candidate, {{&sketch}}, keyframe_from_view) && trackLocalMap(view);
  });
}

bool Tracker::offFloor(const Pose3& keyframe_from_camera) const {
  if (!robot_from_camera_) return false;
  const Pose3 moved = *robot_from_camera_ * keyframe_from_camera * robot_from_camera_->inverse();
  return std::abs(moved.translation().z()) > kMostRise_m || moved.linear()(2, 2) < std::cos(kMostTilt_rad);
}

// Views of one segment that came shortly before and after a keyframe's, in its frame.
std::vector<PlacedSketch> Tracker::around(int keyframe) const {
  const Keyframe& middle = map_.keyframe(keyframe);
  std::vector<PlacedSketch> out{{&middle.sketch}};
  for (const int step : {-1, 1}) {
    int looked_at = 0;
    for (int i = keyframe + step; looked_at < kBeside && std::abs(i - keyframe) <= kFarthestBeside && map_.has(i); i += step) {
      const Keyframe& beside = map_.keyframe(i);
      if (beside.isGivenUp()) continue;
      ++looked_at;
      if (beside.segment == middle.segment)
        out.push_back({&beside.sketch, middle.odom_from_camera.inverse() * beside.odom_from_camera});
    }
  }
  return out;
}

bool Tracker::plausible(int keyframe, const std::vector<PlacedSketch>& here, const Pose3& keyframe_from_here) const {
  return agreement(around(keyframe), here, keyframe_from_here) > kLeastAgreement;
}

bool Tracker::trackNear(View& view) {
  const Pose3 predicted = view.odom_from_camera;
  // Wider and dearer with each attempt; the local map must confirm it.
  for (const double radius : {parameters_.search_radius_px, 3 * parameters_.search_radius_px})
    if (trackLastPoints(view, predicted, radius) && trackLocalMap(view)) return true;
  return trackKeyframe(view, reference_, parameters_.min_inliers) && trackLocalMap(view);
}

bool Tracker::findPose(View& view, const Pose3& previous) {
  if (!carried_ && trackNear(view)) return true;
  if (alignDensely(*view.frame, *view.prior)) {  // never over a pause
    view.odom_from_camera = previous * dead_reckoned_;
    if (trackNear(view)) return true;
  }
  if (!relocalise(view)) return false;
  const bool where_others_say =
      !carried_ && view.prior->previous_from_current && !isFar((previous * dead_reckoned_).inverse() * view.odom_from_camera);
  view.jumped = !where_others_say && !seesLastPoints(reference_);
  return true;
}

bool Tracker::seesLastPoints(int keyframe) const {
  const auto seen = map_.covisible(last_points_);
  return std::any_of(seen.begin(), seen.end(), [&](const auto& entry) {
    return entry.second == keyframe && entry.first >= parameters_.min_inliers;
  });
}

std::vector<std::int64_t> Tracker::localPoints(const View& view) const {
  std::vector<int> keyframes;
  for (const auto& [shared, index] : map_.covisible(view.points))
    if (static_cast<int>(keyframes.size()) < parameters_.local_keyframes) keyframes.push_back(index);
  std::vector<std::int64_t> matched = view.points;
  std::sort(matched.begin(), matched.end());
  auto ids = map_.pointsOf(keyframes);
  std::erase_if(ids, [&](std::int64_t id) { return std::binary_search(matched.begin(), matched.end(), id); });
  return ids;
}

void Tracker::count(const View& view) {
  for (const auto id : view.in_view) ++map_.point(id).visible;
  for (const auto id : view.points)
    if (id >= 0) ++map_.point(id).found;
}

bool Tracker::trackLocalMap(View& view) {
  view.in_view.clear();
  std::copy_if(view.points.begin(), view.points.end(), std::back_inserter(view.in_view),
               [](std::int64_t id) { return id >= 0; });
  const Pose3 camera_from_odom = view.odom_from_camera.inverse();
  const ProjectionSearch search{map_, view.frame->camera, camera_from_odom, parameters_.local_map_radius_px};
  auto matches = search.match(localPoints(view), view.features, view.points, parameters_, &view.in_view);
  leaveOutMover(view, matches);
  assign(view.points, matches);
  if (!solve(view, parameters_.min_inliers, true) || followsMover(view)) return false;
  count(view);
  const auto neighbours = map_.covisible(view.points);
  const bool reference_seen = std::any_of(neighbours.begin(), neighbours.end(),
                                          [&](const auto& entry) { return entry.second == reference_; });
  if (!reference_seen) {
    reference_ = neighbours.front().second;
    reference_inliers_ = 0;
  }
  return true;
}

}  // namespace roomgraph::tracking
