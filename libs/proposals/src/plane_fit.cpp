// SPDX-License-Identifier: BSD-3-Clause
// Tukey-weighted least squares of a plane, and the depth noise model.
#include "plane_fit.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>

namespace roomgraph {
namespace {

// Errors of neighbouring pixels are correlated (disparity steps): so many points count as one independent one.
constexpr double kCorrelation = 25;
// Least standard deviations (rad, m), from the calibration of the depth camera, however many points there are.
constexpr double kAngleFloor = 0.003, kOffsetFloor = 0.005;
constexpr double kTukeyWidth = 3;         // standard deviations
constexpr int kRefinements = 6;           // enough for the weights to settle
constexpr int kLeastInliers = 10;         // with fewer the plane stays as it is
constexpr double kLeastTriangle = 1e-4;   // m², twice the area: smaller ones are taken for collinear
constexpr unsigned kRansacSeed = 12345;

struct Moments {
  double weight = 0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  int count = 0;
};

Moments momentsNear(const Plane& plane, const std::vector<Eigen::Vector3d>& points) {
  Moments m;
  const auto weightOf = [&](const Eigen::Vector3d& p) {
    const double sigma = depthSigma(p.z()) + kSurfaceNoise_m, r = plane.distance(p) / (kTukeyWidth * sigma);
    return std::abs(r) < 1 ? std::pow(1 - r * r, 2) / (sigma * sigma) : 0.0;  // Tukey's biweight
  };
  for (const auto& p : points)
    if (const double w = weightOf(p); w > 0) {
      m.weight += w;
      m.mean += w * p;
      ++m.count;
    }
  if (m.count < 3) return m;
  m.mean /= m.weight;
  for (const auto& p : points)
    if (const double w = weightOf(p); w > 0) m.scatter += w * (p - m.mean) * (p - m.mean).transpose();
  return m;
}

// Covariance of (tilt about both in-plane axes, offset along the normal), propagated to (normal, offset).
Eigen::Matrix4d covarianceOf(const Moments& m, const Eigen::Matrix<double, 3, 2>& axes) {
  const Eigen::Matrix2d tilt_information = axes.transpose() * m.scatter * axes / kCorrelation;
  const Eigen::Matrix2d tilt =
      tilt_information.inverse() + kAngleFloor * kAngleFloor * Eigen::Matrix2d::Identity();
  const double shift = kCorrelation / m.weight + kOffsetFloor * kOffsetFloor;
  // normal = n + axes a; offset = -(n + axes a) . mean - shift
  Eigen::Matrix<double, 4, 3> jacobian = Eigen::Matrix<double, 4, 3>::Zero();
  jacobian.topLeftCorner<3, 2>() = axes;
  jacobian.block<1, 2>(3, 0) = -m.mean.transpose() * axes;
  jacobian(3, 2) = 1;
  Eigen::Matrix3d inner = Eigen::Matrix3d::Zero();
  inner.topLeftCorner<2, 2>() = tilt;
  inner(2, 2) = shift;
  return jacobian * inner * jacobian.transpose();
}

}  // namespace

double depthSigma(double z_m) {
  return 0.0012 + 0.0019 * (z_m - 0.4) * (z_m - 0.4);
}

std::optional<Plane> planeThrough(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                  const Eigen::Vector3d& c) {
  Eigen::Vector3d normal = (b - a).cross(c - a);
  const double length = normal.norm();
  if (length < kLeastTriangle) return std::nullopt;
  normal /= length;
  Plane plane{normal, -normal.dot(a)};
  if (plane.offset < 0) plane = {-plane.normal, -plane.offset};
  return plane;
}

std::optional<Plane> bestPlane(const std::vector<Eigen::Vector3d>& points, int tries,
                               const std::function<int(const Plane&)>& inliers) {
  if (points.size() < 3) return std::nullopt;
  std::mt19937 random(kRansacSeed);
  std::optional<Plane> best;
  int most = 0;
  for (int i = 0; i < tries; ++i) {
    const auto pick = [&] { return points[random() % points.size()]; };
    const Eigen::Vector3d a = pick(), b = pick(), c = pick();
    const auto plane = planeThrough(a, b, c);
    if (!plane) continue;
    if (const int count = inliers(*plane); count > most) {
      most = count;
      best = plane;
    }
  }
  return best;
}

RefinedPlane refinePlane(const Plane& initial, const std::vector<Eigen::Vector3d>& points) {
  RefinedPlane out;
  out.plane = initial;
  for (int iteration = 0; iteration < kRefinements; ++iteration) {
    const Moments m = momentsNear(out.plane, points);
    out.inliers = m.count;
    if (m.count < kLeastInliers) return out;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(m.scatter);
    Eigen::Vector3d normal = axes.eigenvectors().col(0);
    if (normal.dot(initial.normal) < 0) normal = -normal;
    out.plane = {normal, -normal.dot(m.mean)};
    out.spread_m = std::sqrt(axes.eigenvalues()(1) / m.weight);
    if (iteration == kRefinements - 1) out.covariance = covarianceOf(m, axes.eigenvectors().rightCols<2>());
  }
  return out;
}

}  // namespace roomgraph
