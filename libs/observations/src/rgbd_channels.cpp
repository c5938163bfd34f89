// SPDX-License-Identifier: BSD-3-Clause
// Surface normals, gravity by level and plumb surfaces, and the channels made of them.
#include "roomgraph/observations/rgbd_channels.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace roomgraph {
namespace {

constexpr int kReach_px = 2;          ///< normals are those of the triangle of a pixel and two this far away
constexpr double kMaxStep = 0.06;     ///< relative step of depth within one surface, per pixel of distance
constexpr int kLevellingWidth = 128;  ///< px; enough for directions of whole surfaces

/// A depth image of network size with its points.
struct Surface {
  cv::Mat depth;  ///< CV_32F
  PinholeCamera camera;

  Eigen::Vector3f at(int u, int v) const {
    const float z = depth.at<float>(v, u);
    return {z * static_cast<float>((u - camera.cx) / camera.fx),
            z * static_cast<float>((v - camera.cy) / camera.fy), z};
  }
  /// Unit normal towards the camera; nothing at borders, edges and holes.
  std::optional<Eigen::Vector3f> normal(int u, int v) const {
    if (u < kReach_px || v < kReach_px || u >= depth.cols - kReach_px || v >= depth.rows - kReach_px)
      return {};
    const float z = depth.at<float>(v, u);
    const float left = depth.at<float>(v, u - kReach_px), right = depth.at<float>(v, u + kReach_px);
    const float above = depth.at<float>(v - kReach_px, u), below = depth.at<float>(v + kReach_px, u);
    const float most = static_cast<float>(kMaxStep * kReach_px) * z;
    const auto joined = [&](float other) { return other > 0 && std::abs(other - z) < most; };
    if (z <= 0 || !joined(left) || !joined(right) || !joined(above) || !joined(below)) return {};
    const Eigen::Vector3f across = at(u + kReach_px, v) - at(u - kReach_px, v);
    const Eigen::Vector3f down = at(u, v + kReach_px) - at(u, v - kReach_px);
    const Eigen::Vector3f n = down.cross(across);
    const float length = n.norm();
    if (!(length > 0)) return {};
    return n / length;
  }
};

Surface surfaceOf(const cv::Mat& depth, const PinholeCamera& camera, cv::Size size) {
  Surface out;
  cv::resize(depth, out.depth, size, 0, 0, cv::INTER_NEAREST);
  const double sx = static_cast<double>(size.width) / camera.width,
               sy = static_cast<double>(size.height) / camera.height;
  out.camera = {size.width,
                size.height,
                camera.fx * sx,
                camera.fy * sy,
                (camera.cx + 0.5) * sx - 0.5,
                (camera.cy + 0.5) * sy - 0.5,
                {}};
  return out;
}

/// The direction that level normals are along and plumb ones are across of, of those that are within `limit`
/// of it now.
Eigen::Vector3d refined(const Eigen::Vector3d& up, const std::vector<Eigen::Vector3d>& normals,
                        double limit_rad) {
  const double along = std::cos(limit_rad), across = std::sin(limit_rad);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const auto& n : normals) {
    const double c = std::abs(n.dot(up));
    if (c > along) sum -= n * n.transpose();
    if (c < across) sum += n * n.transpose();
  }
  const Eigen::Vector3d best = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(sum).eigenvectors().col(0);
  return best.dot(up) < 0 ? Eigen::Vector3d(-best) : best;
}

/// The lowest height at which enough of the level surfaces lie, of sorted heights; without such, the lowest
/// point.
double floorOf(std::vector<double>& level, std::vector<double>& all) {
  constexpr double kThickness_m = 0.08, kShare = 0.02;
  std::sort(level.begin(), level.end());
  const std::size_t needed =
      std::max<std::size_t>(12, static_cast<std::size_t>(kShare * static_cast<double>(all.size())));
  for (std::size_t i = 0; i + needed <= level.size(); ++i)
    if (level[i + needed - 1] - level[i] < kThickness_m) return level[i + needed / 2];
  const auto lowest = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 50);
  std::nth_element(all.begin(), lowest, all.end());
  return *lowest;
}

uchar scaled(double value, double low, double high) {
  return static_cast<uchar>(1 + 254 * std::clamp((value - low) / (high - low), 0.0, 1.0));
}

}  // namespace

std::optional<Levelling> levelling(const cv::Mat& depth, const PinholeCamera& camera) {
  constexpr std::size_t kLeast = 60;
  const Surface surface =
      surfaceOf(depth, camera, {kLevellingWidth, kLevellingWidth * camera.height / camera.width});
  std::vector<Eigen::Vector3d> normals, points, seen;
  for (int v = 1; v < surface.depth.rows; v += 2) {
    for (int u = 1; u < surface.depth.cols; u += 2) {
      if (surface.depth.at<float>(v, u) <= 0) continue;
      seen.push_back(surface.at(u, v).cast<double>());
      const auto n = surface.normal(u, v);
      if (!n) continue;
      normals.push_back(n->cast<double>());
      points.push_back(seen.back());
    }
  }
  if (normals.size() < kLeast) return {};
  Levelling out;
  for (int i = 0; i < 5; ++i) out.up = refined(out.up, normals, 45 * M_PI / 180);
  for (int i = 0; i < 5; ++i) out.up = refined(out.up, normals, 15 * M_PI / 180);
  std::vector<double> level, all;
  for (const auto& point : seen) all.push_back(point.dot(out.up));
  for (std::size_t i = 0; i < points.size(); ++i)
    if (normals[i].dot(out.up) > 0.94) level.push_back(points[i].dot(out.up));
  out.camera_height_m = -floorOf(level, all);
  return out;
}

std::vector<cv::Mat> rgbdChannels(const cv::Mat& color, const cv::Mat& depth, const PinholeCamera& camera,
                                  cv::Size size) {
  cv::Mat small;
  cv::resize(color, small, size, 0, 0, cv::INTER_AREA);
  std::vector<cv::Mat> out;
  cv::split(small, out);
  while (out.size() < kRgbdChannels) out.push_back(cv::Mat::zeros(size, CV_8U));
  if (depth.empty()) return out;
  const Surface surface = surfaceOf(depth, camera, size);
  const auto level = levelling(depth, camera);
  const Eigen::Vector3f up = level ? Eigen::Vector3f(level->up.cast<float>()) : Eigen::Vector3f(0, -1, 0);
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) {
      const float z = surface.depth.at<float>(v, u);
      if (z <= 0) continue;
      out[kInverseDepth].at<uchar>(v, u) = cv::saturate_cast<uchar>(255 * std::sqrt(0.4f / z));
      if (!level) continue;
      out[kHeight].at<uchar>(v, u) = scaled(surface.at(u, v).dot(up) + level->camera_height_m, -0.2, 2.4);
      if (const auto n = surface.normal(u, v)) out[kSlope].at<uchar>(v, u) = scaled(n->dot(up), -1, 1);
    }
  }
  return out;
}

}  // namespace roomgraph
