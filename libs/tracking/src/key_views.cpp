// SPDX-License-Identifier: BSD-3-Clause
// Choice of corners and views, descriptor matching against all views, PnP for the best.
#include "roomgraph/tracking/key_views.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "matcher.h"
#include "pose_solver.h"

namespace roomgraph {
namespace {

using namespace tracking;

constexpr int kLeastInliers = 20;
constexpr std::size_t kTried = 4;  // views whose geometry is looked at
constexpr double kOtherPlace_m = 0.5, kOtherTurn_rad = 0.2;
constexpr double kMost_mm = 32000;
constexpr double kWider = 1.25;  // growth of the distance between views

Features cornersOf(const Frame& frame, const std::vector<Box2>& excluded, int most) {
  TrackingParameters parameters;
  parameters.max_features = most;
  cv::Mat gray = frame.gray;
  if (gray.empty()) cv::cvtColor(frame.color, gray, cv::COLOR_BGR2GRAY);
  return extractFeatures(gray, frame, excluded, parameters);
}

bool hasImage(const Frame& frame) {
  return !(frame.gray.empty() && frame.color.empty()) && frame.camera.valid();
}

// The place of a view and its direction, weighed: below 1 they are near each other.
double apart(const KeyView& a, const KeyView& b, double apart_m, double apart_rad) {
  const Pose3 between = a.world_from_camera.inverse() * b.world_from_camera;
  return between.translation().norm() / apart_m + rotationAngle(between) / apart_rad;
}

bool isOther(const ViewMatch& a, const ViewMatch& b) {
  const Pose3 between = a.world_from_camera.inverse() * b.world_from_camera;
  return between.translation().norm() > kOtherPlace_m || rotationAngle(between) > kOtherTurn_rad;
}

}  // namespace

KeyView makeKeyView(const Frame& frame, const std::vector<Box2>& excluded, int most_corners) {
  KeyView view;
  view.t = frame.t;
  if (!frame.hasDepth() || !hasImage(frame)) return view;
  // Some corners have no depth.
  const Features features = cornersOf(frame, excluded, most_corners * 3 / 2);
  for (std::size_t i = 0; i < features.size(); ++i) {
    const double depth = static_cast<double>(features.depth[i]);
    if (!(depth > 0) || static_cast<int>(view.corners.size()) == most_corners) continue;
    const Eigen::Vector2d pixel = features.pixel(i);
    const Eigen::Vector3d place_mm = 1000 * frame.camera.backProject(pixel.x(), pixel.y(), depth);
    if (place_mm.cwiseAbs().maxCoeff() > kMost_mm) continue;
    KeyCorner corner{features.descriptors[i], {}};
    for (int k = 0; k < 3; ++k)
      corner.place_mm[static_cast<std::size_t>(k)] = static_cast<std::int16_t>(std::lround(place_mm[k]));
    view.corners.push_back(corner);
  }
  return view;
}

std::vector<KeyView> thinnedViews(std::vector<KeyView> views, std::size_t most, double apart_m,
                                  double apart_rad) {
  std::vector<KeyView> kept;
  if (most == 0) return kept;
  for (double wider = 1;; wider *= kWider) {
    kept.clear();
    for (auto view = views.rbegin(); view != views.rend(); ++view)
      if (std::none_of(kept.begin(), kept.end(), [&](const KeyView& other) {
            return apart(*view, other, wider * apart_m, wider * apart_rad) < 1;
          }))
        kept.push_back(*view);
    if (kept.size() <= most) break;
  }
  std::stable_sort(kept.begin(), kept.end(), [](const KeyView& a, const KeyView& b) { return a.t < b.t; });
  return kept;
}

struct ViewLocator::Views {
  struct View {
    Pose3 world_from_camera;
    std::vector<Descriptor> descriptors;
    std::vector<Eigen::Vector3d> points;  ///< camera, m
  };
  std::vector<View> all;
  TrackingParameters parameters;

  ViewMatch match(std::size_t index, const std::vector<std::pair<int, int>>& pairs, const Features& features,
                  const PinholeCamera& camera) const {
    PoseProblem problem{camera, {}, {}};
    for (const auto& [a, b] : pairs) {
      const auto k = static_cast<std::size_t>(b);
      problem.points.push_back(all[index].points[static_cast<std::size_t>(a)]);
      problem.observations.push_back(
          makeObservation(features.pixel(k), features.places[k].octave, features.depth[k], parameters));
    }
    const PoseSolution solution = ransacPose(problem, kLeastInliers);
    return {all[index].world_from_camera * solution.camera_from_world.inverse(), solution.inliers, index};
  }
};

ViewLocator::ViewLocator(std::vector<KeyView> views) : views_(std::make_unique<Views>()) {
  for (const KeyView& view : views) {
    Views::View out{view.world_from_camera, {}, {}};
    for (const KeyCorner& corner : view.corners) {
      out.descriptors.push_back(corner.descriptor);
      out.points.push_back(Eigen::Vector3d(corner.place_mm[0], corner.place_mm[1], corner.place_mm[2]) /
                           1000);
    }
    views_->all.push_back(std::move(out));
  }
}

ViewLocator::~ViewLocator() = default;

bool ViewLocator::empty() const {
  return views_->all.empty();
}

std::optional<ViewMatch> ViewLocator::locate(const Frame& frame, const std::vector<Box2>& excluded) const {
  if (empty() || !hasImage(frame)) return std::nullopt;
  const Features features = cornersOf(frame, excluded, views_->parameters.max_features);
  std::vector<std::pair<std::vector<std::pair<int, int>>, std::size_t>> promising;
  for (std::size_t i = 0; i < views_->all.size(); ++i) {
    auto pairs = matchDescriptors(views_->all[i].descriptors, features.descriptors, views_->parameters);
    if (static_cast<int>(pairs.size()) >= kLeastInliers) promising.emplace_back(std::move(pairs), i);
  }
  std::stable_sort(promising.begin(), promising.end(),
                   [](const auto& a, const auto& b) { return a.first.size() > b.first.size(); });
  if (promising.size() > kTried) promising.resize(kTried);
  std::vector<ViewMatch> found;
  for (const auto& [pairs, index] : promising)
    if (const ViewMatch match = views_->match(index, pairs, features, frame.camera);
        match.inliers >= kLeastInliers)
      found.push_back(match);
  if (found.empty()) return std::nullopt;
  const ViewMatch best =
      *std::max_element(found.begin(), found.end(),
                        [](const ViewMatch& a, const ViewMatch& b) { return a.inliers < b.inliers; });
  for (const ViewMatch& other : found)
    if (isOther(other, best) && 2 * other.inliers > best.inliers) return std::nullopt;
  return best;
}

}  // namespace roomgraph
