// SPDX-License-Identifier: BSD-3-Clause
// Noise model of a structured-light depth camera and of a colour camera.
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "sensors.h"

namespace roomgraph {
namespace {

constexpr double kUnit_m = 0.001;

/// 1 where another surface hides the point from the projector, which stands `baseline` to the right of the
/// camera.
cv::Mat projectorShadow(const cv::Mat& depth, const CameraSpec& spec) {
  cv::Mat shadow = cv::Mat::zeros(depth.size(), CV_8U);
  for (int v = 0; v < depth.rows; ++v) {
    // Along a row the projector must see the points in the same order as the camera does.
    double leftmost = std::numeric_limits<double>::infinity();
    for (int u = depth.cols - 1; u >= 0; --u) {
      const float z = depth.at<float>(v, u);
      if (z <= 0) continue;
      const double projector_u = u - spec.baseline_m * spec.model.fx / z;
      if (projector_u > leftmost + 0.5) shadow.at<uchar>(v, u) = 1;
      leftmost = std::min(leftmost, projector_u);
    }
  }
  return shadow;
}

/// 1 where the depth jumps within the 3x3 neighbourhood.
cv::Mat depthEdges(const cv::Mat& depth) {
  cv::Mat low, high, edges;
  cv::erode(depth, low, cv::Mat());
  cv::dilate(depth, high, cv::Mat());
  cv::Mat jump = high - low, limit = 0.03 + 0.04 * depth;
  return (jump > limit) / 255;
}

/// Unit variance, alike within a few pixels, as the windows of block matching make it.
cv::Mat correlatedNoise(const cv::Size& size, Random& random) {
  constexpr int kCell_px = 3;
  cv::Mat coarse(size.height / kCell_px + 2, size.width / kCell_px + 2, CV_32F), out;
  for (int v = 0; v < coarse.rows; ++v)
    for (int u = 0; u < coarse.cols; ++u) coarse.at<float>(v, u) = static_cast<float>(random.normal());
  const cv::Mat kernel = cv::getGaussianKernel(7, 1.2, CV_32F);
  cv::sepFilter2D(coarse, coarse, CV_32F, kernel, kernel);
  coarse /= kernel.dot(kernel);  // the filter's gain on white noise, along both axes
  cv::resize(coarse, out, {coarse.cols * kCell_px, coarse.rows * kCell_px}, 0, 0, cv::INTER_LINEAR);
  return out(cv::Rect({0, 0}, size)).clone();
}

}  // namespace

cv::Mat measureDepth(const cv::Mat& depth, const CameraSpec& spec, Random random) {
  constexpr double kLostAtEdge = 0.6;
  const bool noisy = spec.noise_gain > 0;
  const cv::Mat shadow = projectorShadow(depth, spec), edges = depthEdges(depth);
  const double scale = spec.baseline_m * spec.focal_px, steps = 1 / spec.disparity_step_px;
  const cv::Mat noise = correlatedNoise(depth.size(), random) * spec.noise_gain;
  cv::Mat out = cv::Mat::zeros(depth.size(), CV_16U);
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      double z = depth.at<float>(v, u);
      if (z < spec.near_m || z > spec.far_m) continue;
      if (noisy) {
        if (shadow.at<uchar>(v, u) || (edges.at<uchar>(v, u) && random.chance(kLostAtEdge))) continue;
        const double beyond = z - 0.4;
        z += (0.0012 + 0.0019 * beyond * beyond) * noise.at<float>(v, u);
        z = scale / (std::round(steps * scale / z) / steps);
      }
      out.at<std::uint16_t>(v, u) = cv::saturate_cast<std::uint16_t>(z / kUnit_m);
    }
  }
  return out;
}

cv::Mat measureColor(const cv::Mat& color, const cv::Mat& light, const CameraSpec& spec, Random random) {
  constexpr double kVignette = 0.16, kNoise = 2.2;
  const double cx = color.cols / 2.0, cy = color.rows / 2.0, corner = cx * cx + cy * cy;
  cv::Mat out(color.size(), CV_8UC3);
  const bool noisy = spec.noise_gain > 0;
  for (int v = 0; v < color.rows; ++v) {
    for (int u = 0; u < color.cols; ++u) {
      const double radius = ((u - cx) * (u - cx) + (v - cy) * (v - cy)) / corner;
      const double gain = light.at<float>(v, u) * (noisy ? 1 - kVignette * radius : 1);
      // Sum of uniform numbers: near enough to normal for sensor noise, and much cheaper.
      const double common =
          noisy ? kNoise * spec.noise_gain * (random.uniform() + random.uniform() - 1) * 2 : 0;
      for (int k = 0; k < 3; ++k)
        out.at<cv::Vec3b>(v, u)[k] = cv::saturate_cast<uchar>(gain * color.at<cv::Vec3b>(v, u)[k] + common);
    }
  }
  return out;
}

}  // namespace roomgraph
