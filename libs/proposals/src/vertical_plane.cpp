// SPDX-License-Identifier: BSD-3-Clause
// RANSAC over point pairs and weighted total least squares.
#include "vertical_plane.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "plane_fit.h"

namespace roomgraph {
namespace {

constexpr int kTries = 120;  // of RANSAC
constexpr unsigned kPairSeed = 777;
constexpr double kLeastPair_m = 0.1;      // nearer points tell no direction
constexpr std::size_t kLeastInPlane = 30;
constexpr double kLeastShare = 0.35;      // of inliers among the points
constexpr double kPointsPerSample = 25;   // errors of neighbouring pixels are correlated: so many count as one
// Inliers are this near to the plane: m, and standard deviations.
constexpr double kOnWall_m = 0.01, kOnWallSigmas = 2.5;
// Least standard deviations (rad, m), from the camera's calibration and a door's panels.
constexpr double kWallAngleFloor = 0.01, kWallOffsetFloor = 0.012;

// Standard deviation of a point across the plane, m.
double noiseAcross(const VerticalPlane& plane, const Eigen::Vector2d& p) {
  const double range = std::max(p.norm(), 1e-6);
  return kSurfaceNoise_m + depthSigma(range) * std::abs(plane.normal.dot(p)) / range;
}

std::ptrdiff_t inliers(const VerticalPlane& plane, const std::vector<Eigen::Vector2d>& points) {
  return std::count_if(points.begin(), points.end(),
                       [&](const Eigen::Vector2d& p) { return isInlier(plane, p); });
}

// Total least squares on the inliers, each with its own noise.
VerticalPlane refined(const VerticalPlane& initial, const std::vector<Eigen::Vector2d>& points) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  double total = 0;
  for (const auto& p : points) {
    if (!isInlier(initial, p)) continue;
    const double weight = std::pow(noiseAcross(initial, p), -2);
    mean += weight * p;
    second += weight * p * p.transpose();
    total += weight;
  }
  mean /= total;
  const Eigen::Matrix2d scatter = second - total * mean * mean.transpose();
  const double angle = 0.5 * std::atan2(2 * scatter(0, 1), scatter(0, 0) - scatter(1, 1));
  const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
  VerticalPlane out = planeThrough(mean, mean + direction);
  out.middle = out.along().dot(mean);
  const double spread = std::max(direction.dot(scatter * direction), 1e-6);
  out.sigma_m = std::sqrt(kPointsPerSample / total + kWallOffsetFloor * kWallOffsetFloor);
  out.sigma_rad = std::sqrt(kPointsPerSample / spread + kWallAngleFloor * kWallAngleFloor);
  return out;
}

}  // namespace

bool isInlier(const VerticalPlane& plane, const Eigen::Vector2d& p) {
  return std::abs(plane.normal.dot(p) - plane.offset) < kOnWall_m + kOnWallSigmas * noiseAcross(plane, p);
}

VerticalPlane planeThrough(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = (b - a).normalized();
  VerticalPlane plane;
  plane.normal = {-along.y(), along.x()};
  plane.offset = plane.normal.dot(a);
  if (plane.offset > 0) {
    plane.normal = -plane.normal;
    plane.offset = -plane.offset;
  }
  plane.middle = plane.along().dot(a + b) / 2;
  return plane;
}

std::optional<VerticalPlane> fitVerticalPlane(const std::vector<Eigen::Vector2d>& points) {
  if (points.size() < kLeastInPlane) return std::nullopt;
  std::mt19937 random(kPairSeed);
  VerticalPlane best;
  std::ptrdiff_t most = 0;
  for (int i = 0; i < kTries; ++i) {
    const Eigen::Vector2d a = points[random() % points.size()], b = points[random() % points.size()];
    if ((b - a).norm() < kLeastPair_m) continue;
    const VerticalPlane plane = planeThrough(a, b);
    if (const auto count = inliers(plane, points); count > most) {
      most = count;
      best = plane;
    }
  }
  const auto all = static_cast<double>(points.size());
  if (static_cast<double>(most) < kLeastShare * all) return std::nullopt;
  VerticalPlane plane = refined(refined(best, points), points);
  plane.inlier_share = static_cast<double>(inliers(plane, points)) / all;
  return plane;
}

}  // namespace roomgraph
