// SPDX-License-Identifier: BSD-3-Clause
// Resizing of brightness and depth, and normals from neighbouring depths.
#include "dense_image.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace roomgraph::tracking {
namespace {

constexpr int kFinestWidth = 160, kLevels = 2;
constexpr int kSide = 7;  // px, of the square that a normal is fitted to
constexpr double kClumped =
    8;  // neighbours err alike: normals scatter by so much more than independent depths would
constexpr double kMaxOff = 0.02;  // of its depths from the plane, as a share: more is an edge
constexpr float kMaxDepth_m = 8;
constexpr double kBlur_px = 1.5, kSlow_px = 6;

cv::Mat brightnessOf(const Frame& frame, const cv::Size& size) {
  cv::Mat gray = frame.gray, small;
  if (gray.empty()) cv::cvtColor(frame.color, gray, cv::COLOR_BGR2GRAY);
  cv::resize(gray, small, size, 0, 0, cv::INTER_AREA);
  cv::Mat out;
  small.convertTo(out, CV_32F);
  // Finer texture than a movement between two images would lead astray.
  cv::GaussianBlur(out, out, {}, kBlur_px);
  // Slow changes are exposure, shading, or the light that a camera carries along.
  cv::Mat slow;
  cv::GaussianBlur(out, slow, {}, kSlow_px);
  return out - slow;
}

// The plane around each pixel: inverse depth is linear in the pixel on it.
void fitNormals(DenseLevel& level) {
  const cv::Mat& depth = level.depth;
  const PinholeCamera& camera = level.camera;
  cv::Mat inverse, within;
  cv::divide(1.0, depth, inverse, CV_64F);
  inverse.setTo(0, depth <= 0);
  cv::erode(depth > 0, within, cv::Mat::ones(kSide, kSide, CV_8UC1), {-1, -1}, 1, cv::BORDER_CONSTANT, 0);
  cv::Mat ramp(1, kSide, CV_64FC1);
  for (int i = 0; i < kSide; ++i) ramp.at<double>(i) = i - kSide / 2;
  const cv::Mat slope = ramp / ramp.dot(ramp), mean = cv::Mat::ones(1, kSide, CV_64FC1) / kSide;
  cv::Mat by_u, by_v, middle, square;
  cv::sepFilter2D(inverse, by_u, CV_64F, slope, mean);
  cv::sepFilter2D(inverse, by_v, CV_64F, mean, slope);
  cv::sepFilter2D(inverse, middle, CV_64F, mean, mean);
  cv::sepFilter2D(inverse.mul(inverse), square, CV_64F, mean, mean);
  const double spread = ramp.dot(ramp) / kSide;
  level.normals = cv::Mat::zeros(depth.size(), CV_32FC3);
  level.normal_variance = cv::Mat::zeros(depth.size(), CV_32FC1);
  for (int v = 0; v < depth.rows; ++v)
    for (int u = 0; u < depth.cols; ++u) {
      if (!within.at<uchar>(v, u)) continue;
      const double a = by_u.at<double>(v, u), b = by_v.at<double>(v, u), q = middle.at<double>(v, u);
      const double off = square.at<double>(v, u) - q * q - (a * a + b * b) * spread;
      if (off > kMaxOff * kMaxOff * q * q) continue;
      Eigen::Vector3d normal(-a * camera.fx, -b * camera.fy, -q);
      normal.z() -= normal.x() * (u - camera.cx) / camera.fx + normal.y() * (v - camera.cy) / camera.fy;
      normal.normalize();
      level.normals.at<cv::Vec3f>(v, u) = {static_cast<float>(normal.x()), static_cast<float>(normal.y()),
                                           static_cast<float>(normal.z())};
      const double spread_of_slope = std::max(0.0, off) / (kSide * kSide * spread);
      level.normal_variance.at<float>(v, u) =
          static_cast<float>(kClumped * spread_of_slope * camera.fx * camera.fx / (q * q));
    }
}

DenseLevel levelOf(const Frame& frame, const std::vector<Box2>& excluded, double factor) {
  DenseLevel level;
  level.camera = frame.camera.scaled(factor);
  level.brightness = brightnessOf(frame, {level.camera.width, level.camera.height});
  cv::Sobel(level.brightness, level.slope_x, CV_32F, 1, 0, 3, 1.0 / 8);
  cv::Sobel(level.brightness, level.slope_y, CV_32F, 0, 1, 3, 1.0 / 8);
  level.depth = coarseDepth(frame, excluded, level.camera, kMaxDepth_m);
  fitNormals(level);
  return level;
}

}  // namespace

cv::Mat coarseDepth(const Frame& frame, const std::vector<Box2>& excluded, const PinholeCamera& camera, float farthest_m) {
  cv::Mat out(camera.height, camera.width, CV_32FC1);
  const double scale = static_cast<double>(frame.camera.width) / camera.width;
  for (int v = 0; v < out.rows; ++v)
    for (int u = 0; u < out.cols; ++u) {
      const double x = (u + 0.5) * scale - 0.5, y = (v + 0.5) * scale - 0.5;
      const bool left_out =
          std::any_of(excluded.begin(), excluded.end(), [&](const Box2& box) { return box.contains(x, y); });
      const float z = left_out ? 0.f : frame.depthAt(x, y);
      out.at<float>(v, u) = z < farthest_m ? z : 0.f;
    }
  return out;
}

DenseImage::DenseImage(const Frame& frame, const std::vector<Box2>& excluded) {
  double factor = static_cast<double>(kFinestWidth) / frame.camera.width;
  for (int i = 0; i < kLevels; ++i, factor /= 2) levels_.push_back(levelOf(frame, excluded, factor));
}

}  // namespace roomgraph::tracking
