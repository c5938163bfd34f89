// SPDX-License-Identifier: BSD-3-Clause
// Median scale and shift of point pairs; reprojection of a static box.
#include "box_motion.h"

#include <algorithm>
#include <cmath>

#include "roomgraph/core/order_statistics.h"
#include "roomgraph/geometry/box_sides.h"

namespace roomgraph {
namespace {

constexpr std::size_t kLeastPairs = 4;
constexpr double kBaseline_px = 8;  // shorter distances tell nothing about the scale
constexpr std::size_t kLeastRatios = 6;

double medianScale(const std::vector<cv::Point2f>& then, const std::vector<cv::Point2f>& now) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < then.size(); ++i)
    for (std::size_t k = i + 1; k < then.size(); ++k)
      if (const double before = cv::norm(then[i] - then[k]); before >= kBaseline_px)
        ratios.push_back(cv::norm(now[i] - now[k]) / before);
  return ratios.size() < kLeastRatios ? 1 : std::clamp(median(ratios), 0.25, 4.0);
}

}  // namespace

Box2 BoxMotion::apply(const Box2& box) const {
  return {scale * box.u_min + shift_u, scale * box.v_min + shift_v, scale * box.u_max + shift_u,
          scale * box.v_max + shift_v};
}

std::optional<BoxMotion> fitMotion(const std::vector<cv::Point2f>& then, const std::vector<cv::Point2f>& now,
                                   double size_px) {
  if (then.size() < kLeastPairs || then.size() != now.size()) return std::nullopt;
  BoxMotion motion;
  motion.scale = medianScale(then, now);
  std::vector<double> u, v;
  for (std::size_t i = 0; i < then.size(); ++i) {
    u.push_back(now[i].x - motion.scale * then[i].x);
    v.push_back(now[i].y - motion.scale * then[i].y);
  }
  motion.shift_u = median(u);
  motion.shift_v = median(v);
  const double tolerance = std::max(2.0, 0.02 * size_px);
  for (std::size_t i = 0; i < then.size(); ++i)
    if (std::hypot(u[i] - motion.shift_u, v[i] - motion.shift_v) <= tolerance) motion.inliers.push_back(i);
  if (motion.inliers.size() < kLeastPairs) return std::nullopt;
  return motion;
}

double objectDepth(const Box2& box, const Frame& frame) {
  const Eigen::Vector2d center = box.center();
  const double half_u = 0.3 * box.width(), half_v = 0.3 * box.height();
  std::vector<float> depths;
  constexpr int kSteps = 16;
  for (int i = 0; i <= kSteps; ++i)
    for (int k = 0; k <= kSteps; ++k) {
      const double ratio_u = 2.0 * i / kSteps - 1, ratio_v = 2.0 * k / kSteps - 1;
      const float depth = frame.depthAt(center.x() + ratio_u * half_u, center.y() + ratio_v * half_v);
      if (depth > 0) depths.push_back(depth);
    }
  if (depths.empty()) return 0;
  const auto third = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 3);
  std::nth_element(depths.begin(), third, depths.end());
  return *third;
}

std::optional<PlacedBox> carriedByCamera(const Box2& box, double depth_m, const PinholeCamera& camera,
                                         const Pose3& current_from_previous) {
  const auto moved = [&](double u, double v) {
    return Eigen::Vector3d(current_from_previous * camera.backProject(u, v, depth_m));
  };
  const Eigen::Vector3d middle = moved(box.center().x(), box.center().y());
  if (middle.z() < 0.2) return std::nullopt;
  // The middle's depth for all corners: the box stays upright and its sides parallel to the image's.
  const double scale = depth_m / middle.z();
  const Eigen::Vector2d center = camera.project(middle);
  const double half_u = scale * box.width() / 2, half_v = scale * box.height() / 2;
  return PlacedBox{{center.x() - half_u, center.y() - half_v, center.x() + half_u, center.y() + half_v},
                   middle.z()};
}

Box2 stayingCut(const Box2& box, const Box2& before, int width, int height) {
  Box2 out = box;
  const BoxSides inside = sidesInside(before, width, height);
  if (!inside.left) out.u_min = std::min(out.u_min, 0.0);
  if (!inside.top) out.v_min = std::min(out.v_min, 0.0);
  if (!inside.right) out.u_max = std::max(out.u_max, static_cast<double>(width));
  if (!inside.bottom) out.v_max = std::max(out.v_max, static_cast<double>(height));
  return out;
}

}  // namespace roomgraph
