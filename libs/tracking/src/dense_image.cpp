// SPDX-License-Identifier: BSD-3-Clause
// Resizing of brightness and depth, and normals from neighbouring depths.
#include "dense_image.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace roomgraph::tracking {
namespace {

constexpr int kFinestWidth = 160, kLevels = 2;
constexpr float kMaxStep = 0.06f;  // of depth between neighbours, as a share: more is an edge
constexpr float kMaxDepth_m = 8;
constexpr double kBlur_px = 1.5;

cv::Mat brightnessOf(const Frame& frame, const cv::Size& size) {
  cv::Mat gray = frame.gray, small;
  if (gray.empty()) cv::cvtColor(frame.color, gray, cv::COLOR_BGR2GRAY);
  cv::resize(gray, small, size, 0, 0, cv::INTER_AREA);
  cv::Mat out;
  small.convertTo(out, CV_32F);
  // Finer texture than a movement between two images would lead astray.
  cv::GaussianBlur(out, out, {}, kBlur_px);
  return out;
}

// Depth is not averaged: between an object and what is behind it there is nothing.
cv::Mat depthOf(const Frame& frame, const std::vector<Box2>& excluded, const PinholeCamera& camera) {
  cv::Mat out(camera.height, camera.width, CV_32FC1);
  const double scale = static_cast<double>(frame.camera.width) / camera.width;
  for (int v = 0; v < out.rows; ++v)
    for (int u = 0; u < out.cols; ++u) {
      const double x = (u + 0.5) * scale - 0.5, y = (v + 0.5) * scale - 0.5;
      const bool left_out = std::any_of(excluded.begin(), excluded.end(),
                                        [&](const Box2& box) { return box.contains(x, y); });
      const float z = left_out ? 0.f : frame.depthAt(x, y);
      out.at<float>(v, u) = z < kMaxDepth_m ? z : 0.f;
    }
  return out;
}

cv::Vec3f normalAt(const cv::Mat& depth, const PinholeCamera& camera, int u, int v) {
  const auto z = [&](int x, int y) { return depth.at<float>(y, x); };
  const float here = z(u, v);
  for (const float other : {z(u - 1, v), z(u + 1, v), z(u, v - 1), z(u, v + 1)})
    if (here <= 0 || other <= 0 || std::abs(other - here) > kMaxStep * here) return {};
  const auto at = [&](int x, int y) -> Eigen::Vector3d { return camera.backProject(x, y, z(x, y)); };
  Eigen::Vector3d normal = (at(u, v + 1) - at(u, v - 1)).cross(at(u + 1, v) - at(u - 1, v)).normalized();
  if (normal.dot(at(u, v)) > 0) normal = -normal;
  return {static_cast<float>(normal.x()), static_cast<float>(normal.y()), static_cast<float>(normal.z())};
}

cv::Mat normalsOf(const cv::Mat& depth, const PinholeCamera& camera) {
  cv::Mat out = cv::Mat::zeros(depth.size(), CV_32FC3);
  for (int v = 1; v + 1 < depth.rows; ++v)
    for (int u = 1; u + 1 < depth.cols; ++u) out.at<cv::Vec3f>(v, u) = normalAt(depth, camera, u, v);
  return out;
}

DenseLevel levelOf(const Frame& frame, const std::vector<Box2>& excluded, double factor) {
  DenseLevel level;
  level.camera = frame.camera.scaled(factor);
  level.brightness = brightnessOf(frame, {level.camera.width, level.camera.height});
  cv::Sobel(level.brightness, level.slope_x, CV_32F, 1, 0, 3, 1.0 / 8);
  cv::Sobel(level.brightness, level.slope_y, CV_32F, 0, 1, 3, 1.0 / 8);
  level.depth = depthOf(frame, excluded, level.camera);
  level.normals = normalsOf(level.depth, level.camera);
  return level;
}

}  // namespace

DenseImage::DenseImage(const Frame& frame, const std::vector<Box2>& excluded) {
  double factor = static_cast<double>(kFinestWidth) / frame.camera.width;
  for (int i = 0; i < kLevels; ++i, factor /= 2) levels_.push_back(levelOf(frame, excluded, factor));
}

}  // namespace roomgraph::tracking
