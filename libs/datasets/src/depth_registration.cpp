// SPDX-License-Identifier: BSD-3-Clause
// Undistorted pixel rays and forward projection of depth pixels with nearest-surface test.
#include "depth_registration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <tuple>

#include "recent.h"

namespace roomgraph {
namespace {

constexpr double kFarthest_px = 1e6;  // cameras that cannot be put points anywhere
// Half of the side that one depth pixel may cover: a surface that nearly touches the target camera, or a focal length that
// cannot be, must not paint the whole image for each pixel.
constexpr double kWidest_px = 32;

cv::Mat makeRays(const PinholeCamera& camera, const Distortion& lens) {
  cv::Mat pixels(camera.height, camera.width, CV_32FC2);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
      pixels.at<cv::Vec2f>(v, u) = {static_cast<float>(u), static_cast<float>(v)};
  const cv::Matx33d k(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  const cv::Mat points = pixels.reshape(2, camera.width * camera.height);
  cv::Mat rays;
  if (lens.isFisheye())
    cv::fisheye::undistortPoints(points, rays, k, lens.coefficients);
  else
    cv::undistortPoints(points, rays, k, lens.coefficients);
  return rays.reshape(2, camera.height);
}

}  // namespace

cv::Mat pixelRays(const PinholeCamera& camera, const Distortion& lens) {
  using Key = std::tuple<std::array<double, 4>, Distortion, int, int>;
  static Recent<Key, cv::Mat> recent(2);
  const Key key({camera.fx, camera.fy, camera.cx, camera.cy}, lens, camera.width, camera.height);
  return recent.of(key, [&] { return makeRays(camera, lens); });
}

void rangesToDepth(cv::Mat& range, const cv::Mat& rays) {
  for (int v = 0; v < range.rows; ++v)
    for (int u = 0; u < range.cols; ++u) {
      const auto& ray = rays.at<cv::Vec2f>(v, u);
      range.at<float>(v, u) /= std::sqrt(1.f + ray[0] * ray[0] + ray[1] * ray[1]);
    }
}

cv::Mat registerDepth(const cv::Mat& depth, const cv::Mat& rays, double depth_fx,
                      const Pose3& target_from_depth, const PinholeCamera& target) {
  cv::Mat out = cv::Mat::zeros(target.height, target.width, CV_32FC1);
  for (int v = 0; v < depth.rows; ++v)
    for (int u = 0; u < depth.cols; ++u) {
      const double z = depth.at<float>(v, u);
      if (!(z > 0)) continue;
      const auto& ray = rays.at<cv::Vec2f>(v, u);
      const Eigen::Vector3d p = target_from_depth * Eigen::Vector3d(z * ray[0], z * ray[1], z);
      if (!(p.z() > 0)) continue;
      const Eigen::Vector2d centre = target.project(p);
      if (!(std::abs(centre.x()) < kFarthest_px) || !(std::abs(centre.y()) < kFarthest_px)) continue;
      // Half the width a depth pixel covers in the target; at least one target pixel is hit.
      const double half = std::clamp(0.5 * target.fx / depth_fx * z / p.z(), 0.5, kWidest_px);
      const int left = std::max(0, static_cast<int>(std::ceil(centre.x() - half)));
      const int right = std::min(target.width, static_cast<int>(std::ceil(centre.x() + half)));
      const int top = std::max(0, static_cast<int>(std::ceil(centre.y() - half)));
      const int bottom = std::min(target.height, static_cast<int>(std::ceil(centre.y() + half)));
      for (int y = top; y < bottom; ++y)
        for (int x = left; x < right; ++x) {
          float& nearest = out.at<float>(y, x);
          if (nearest == 0.f || p.z() < nearest) nearest = static_cast<float>(p.z());
        }
    }
  return out;
}

}  // namespace roomgraph
