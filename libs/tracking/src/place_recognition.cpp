// SPDX-License-Identifier: BSD-3-Clause
// Small blurry images, recognition of a keyframe, and loop candidates.
#include "place_recognition.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace roomgraph::tracking {
namespace {

constexpr double kNearDistance = 2.0;  // m
constexpr double kNearAngle = 0.7;     // rad

/// Point that a keyframe's feature shows, in the keyframe's camera frame; nothing without map point and
/// depth.
std::optional<Eigen::Vector3d> pointInKeyframe(const LocalMap& map, const Keyframe& keyframe, std::size_t i) {
  const auto id = keyframe.points[i];
  if (id >= 0) return keyframe.odom_from_camera.inverse() * map.point(id).position;
  if (!(keyframe.features.depth[i] > 0)) return std::nullopt;
  const Eigen::Vector2d pixel = keyframe.features.pixel(i);
  return keyframe.camera.backProject(pixel.x(), pixel.y(), keyframe.features.depth[i]);
}

}  // namespace

cv::Mat makeThumbnail(const cv::Mat& gray) {
  cv::Mat small, thumbnail;
  cv::resize(gray, small, {40, 30}, 0, 0, cv::INTER_AREA);
  small.convertTo(thumbnail, CV_32F);
  cv::GaussianBlur(thumbnail, thumbnail, {}, 1.5);
  thumbnail -= cv::mean(thumbnail);
  const double norm = cv::norm(thumbnail);
  if (norm > 1e-6) thumbnail /= norm;
  return thumbnail;
}

double similarity(const cv::Mat& thumbnail_a, const cv::Mat& thumbnail_b) {
  return thumbnail_a.dot(thumbnail_b);
}

Recognition recognize(const LocalMap& map, int index, const Features& features, const PinholeCamera& camera,
                      const TrackingParameters& parameters) {
  const Keyframe& keyframe = map.keyframe(index);
  PoseProblem problem{camera, {}, {}};
  std::vector<PointMatch> matches;
  for (const auto& [a, b] :
       matchDescriptors(keyframe.features.descriptors, features.descriptors, parameters)) {
    const auto i = static_cast<std::size_t>(a), k = static_cast<std::size_t>(b);
    const auto point = pointInKeyframe(map, keyframe, i);
    if (!point) continue;
    problem.points.push_back(*point);
    problem.observations.push_back(
        makeObservation(features.pixel(k), features.places[k].octave, features.depth[k], parameters));
    matches.push_back({keyframe.points[i], b});
  }
  Recognition out{ransacPose(problem, parameters.min_inliers), {}};
  for (std::size_t i = 0; i < matches.size(); ++i)
    if (out.solution.inlier[i] && matches[i].point >= 0) out.known_points.push_back(matches[i]);
  return out;
}

std::vector<int> mostSimilar(const LocalMap& map, const cv::Mat& thumbnail, int end, int count) {
  std::vector<std::pair<double, int>> ranked;
  for (int i = 0; i < end; ++i)
    if (!map.keyframe(i).isGivenUp()) ranked.emplace_back(-similarity(map.keyframe(i).thumbnail, thumbnail), i);
  std::sort(ranked.begin(), ranked.end());
  std::vector<int> out;
  for (int i = 0; i < std::min<int>(count, static_cast<int>(ranked.size())); ++i)
    out.push_back(ranked[static_cast<std::size_t>(i)].second);
  return out;
}

std::vector<int> loopCandidates(const LocalMap& map, int index, const TrackingParameters& parameters) {
  const int end = index - parameters.loop_min_gap;
  if (end <= 0 || parameters.loop_candidates == 0) return {};
  const Keyframe& current = map.keyframe(index);
  std::vector<int> out = mostSimilar(map, current.thumbnail, end, parameters.loop_candidates);
  int nearest = -1;
  double least = 1;
  for (int i = 0; i < end; ++i) {
    if (map.keyframe(i).isGivenUp() || map.keyframe(i).origin != current.origin) continue;
    const Pose3 between = map.keyframe(i).odom_from_camera.inverse() * current.odom_from_camera;
    const double cost = between.translation().norm() / kNearDistance + rotationAngle(between) / kNearAngle;
    if (cost < least) {
      least = cost;
      nearest = i;
    }
  }
  if (nearest >= 0 && std::find(out.begin(), out.end(), nearest) == out.end()) out.push_back(nearest);
  return out;
}

}  // namespace roomgraph::tracking
