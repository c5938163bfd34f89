// SPDX-License-Identifier: BSD-3-Clause
// Screen-space ambient occlusion from a depth image.
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "color_renderer.h"
#include "parallel.h"

namespace roomgraph {
namespace {

constexpr int kPattern = 4;  ///< directions repeat every 4 x 4 pixels; the blur averages over one such cell
constexpr std::size_t kSamples = 10;
constexpr double kReach_m = 0.45;
constexpr double kStrength = 1.5;

struct Points {
  const cv::Mat& depth;
  PinholeCamera camera;
  Eigen::Vector3d at(int u, int v) const { return camera.backProject(u, v, depth.at<float>(v, u)); }
};

/// Normal towards the camera, from the nearer neighbour on each axis.
Eigen::Vector3d normalAt(const Points& points, int u, int v) {
  const Eigen::Vector3d p = points.at(u, v);
  const auto nearer = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) -> Eigen::Vector3d {
    return std::abs(a.z() - p.z()) < std::abs(b.z() - p.z()) ? Eigen::Vector3d(a - p)
                                                             : Eigen::Vector3d(p - b);
  };
  const Eigen::Vector3d du = nearer(points.at(u + 1, v), points.at(u - 1, v));
  const Eigen::Vector3d dv = nearer(points.at(u, v + 1), points.at(u, v - 1));
  const Eigen::Vector3d normal = dv.cross(du);
  return normal.norm() > 1e-12 ? Eigen::Vector3d(normal.normalized()) : Eigen::Vector3d(0, 0, -1);
}

/// Where a pixel of the pattern looks: a direction in the image and a share of the reach.
struct Ray {
  double u, v, share;
};
using Rays = std::array<Ray, kSamples>;

/// By (column % kPattern) * kPattern + row % kPattern.
std::array<Rays, kPattern * kPattern> raysOfPattern() {
  std::array<Rays, kPattern * kPattern> out;
  for (std::size_t cell = 0; cell < out.size(); ++cell)
    for (std::size_t i = 0; i < kSamples; ++i) {
      const double angle =
          static_cast<double>(cell) * 0.3927 + 2.399963 * static_cast<double>(i);  // golden angle
      out[cell][i] = {std::cos(angle), std::sin(angle), std::sqrt((static_cast<double>(i) + 0.5) / kSamples)};
    }
  return out;
}

double occlusionAt(const Points& points, const Rays& rays, int u, int v) {
  const Eigen::Vector3d p = points.at(u, v), normal = normalAt(points, u, v);
  const double reach_px = std::min(kReach_m * points.camera.fx / p.z(), points.camera.width / 3.0);
  double sum = 0;
  for (const Ray& ray : rays) {
    const double radius = reach_px * ray.share;
    const int su = u + static_cast<int>(std::lround(radius * ray.u));
    const int sv = v + static_cast<int>(std::lround(radius * ray.v));
    if (su < 0 || sv < 0 || su >= points.depth.cols || sv >= points.depth.rows ||
        points.depth.at<float>(sv, su) <= 0)
      continue;
    const Eigen::Vector3d d = points.at(su, sv) - p;
    const double length = d.norm();
    if (length > 1e-6)
      sum += std::max(0.0, d.dot(normal) / length - 0.08) * std::max(0.0, 1 - length / (1.6 * kReach_m));
  }
  return sum / kSamples;
}

}  // namespace

cv::Mat ambientLight(const cv::Mat& depth, const PinholeCamera& camera) {
  cv::Mat half;
  cv::resize(depth, half, {depth.cols / 2, depth.rows / 2}, 0, 0, cv::INTER_NEAREST);
  // Nearest neighbour takes the pixels 2u, 2v.
  PinholeCamera half_camera{half.cols,     half.rows, camera.fx / 2, camera.fy / 2, camera.cx / 2,
                            camera.cy / 2, {}};
  const Points points{half, half_camera};
  cv::Mat light(half.size(), CV_32F, cv::Scalar(1));
  const auto rays = raysOfPattern();
  parallelFor(1, half.rows - 1, [&](int v) {
    for (int u = 1; u < half.cols - 1; ++u)
      if (half.at<float>(v, u) > 0)
        light.at<float>(v, u) = static_cast<float>(std::max(
            0.15, 1 - kStrength *
                          occlusionAt(points,
                                      rays[static_cast<std::size_t>(u % kPattern * kPattern + v % kPattern)],
                                      u, v)));
  });
  cv::Mat out;
  cv::blur(light, light, {kPattern, kPattern});
  cv::resize(light, out, depth.size(), 0, 0, cv::INTER_LINEAR);
  return out;
}

}  // namespace roomgraph
