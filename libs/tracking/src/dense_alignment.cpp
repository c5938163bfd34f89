// SPDX-License-Identifier: BSD-3-Clause
// Residuals, weights and Gauss-Newton steps of dense alignment.
#include "dense_alignment.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace roomgraph::tracking {
namespace {

constexpr int kIterations = 12;
constexpr int kLeastPixels = 150;
constexpr double kLeastOverlap = 0.25;
constexpr double kStill = 1e-5;               // m, rad
constexpr double kGate_m = 0.15, kGatePerLevel = 2;  // coarser levels allow for more
constexpr double kBrightnessSigma = 8;        // grey levels, with what exposure and shading do
constexpr double kHuber = 1.5;
// Less is noise, which would tie the images to each other, or the light that a camera carries along.
constexpr double kLeastSlope = 4;  // grey levels per px
// Where both images have contrast, they must look alike: another place has the same walls.
constexpr double kContrast = 6, kLeastCorrelation = 0.5;
// Neighbouring pixels err alike: so many count as one.
constexpr double kAlike = 40;

double depthSigma(double z) {
  return 0.004 + 0.004 * z * z;
}

// Of pairs of brightnesses.
struct Likeness {
  double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;

  void add(double first, double second) {
    n += 1, a += first, b += second, aa += first * first, bb += second * second, ab += first * second;
  }
  double bias() const { return (a - b) / n; }
  bool isAlike() const {
    const double first = aa / n - a * a / (n * n), second = bb / n - b * b / (n * n);
    if (std::min(first, second) < kContrast * kContrast) return true;
    return ab / n - a * b / (n * n) > kLeastCorrelation * std::sqrt(first * second);
  }
};

struct Normal {
  Matrix6d information = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  int pixels = 0, met = 0;
  Likeness brightness;

  void add(const Vector6d& derivative, double residual, double sigma) {
    const double size = std::abs(residual) / sigma;
    const double weight = (size <= kHuber ? 1 : kHuber / size) / (sigma * sigma);
    information += weight * derivative * derivative.transpose();
    gradient += weight * residual * derivative;
  }
};

// A point of the current image in the reference's frame, and the pixel there.
struct Met {
  Eigen::Vector3d point, on_surface, normal;
  int u, v;
};

std::optional<Met> meet(const DenseLevel& reference, const Eigen::Vector3d& point, double gate_m) {
  if (point.z() <= 0) return std::nullopt;
  const Eigen::Vector2d pixel = reference.camera.project(point);
  const int u = static_cast<int>(std::lround(pixel.x())), v = static_cast<int>(std::lround(pixel.y()));
  if (u < 0 || v < 0 || u >= reference.depth.cols || v >= reference.depth.rows) return std::nullopt;
  const float z = reference.depth.at<float>(v, u);
  const cv::Vec3f n = reference.normals.at<cv::Vec3f>(v, u);
  if (z <= 0 || n == cv::Vec3f()) return std::nullopt;
  const Met met{point, reference.camera.backProject(u, v, z), {n[0], n[1], n[2]}, u, v};
  if (std::abs(met.normal.dot(point - met.on_surface)) > gate_m) return std::nullopt;
  return met;
}

// Of (translation, rotation) of the point about the reference's origin.
Vector6d pointDerivative(const Eigen::Vector3d& by_point, const Eigen::Vector3d& point) {
  Vector6d out;
  out << by_point, point.cross(by_point);
  return out;
}

void addBrightness(const DenseLevel& reference, const Met& met, double brightness, double bias, Normal& normal) {
  const double there = reference.brightness.at<float>(met.v, met.u), difference = there - brightness;
  normal.brightness.add(there, brightness);
  const double sx = reference.slope_x.at<float>(met.v, met.u), sy = reference.slope_y.at<float>(met.v, met.u);
  if (std::hypot(sx, sy) < kLeastSlope) return;
  const PinholeCamera& camera = reference.camera;
  const Eigen::Vector3d& p = met.point;
  const Eigen::Vector2d pixel = camera.project(p);
  // To the place between the pixels.
  const double between = sx * (pixel.x() - met.u) + sy * (pixel.y() - met.v);
  const Eigen::Vector3d by_point(sx * camera.fx / p.z(), sy * camera.fy / p.z(),
                                 -(sx * camera.fx * p.x() + sy * camera.fy * p.y()) / (p.z() * p.z()));
  normal.add(pointDerivative(by_point, p), difference + between - bias, kBrightnessSigma);
}

Normal linearise(const DenseLevel& reference, const DenseLevel& current, const Pose3& reference_from_current,
                 double gate_m, double bias) {
  Normal normal;
  for (int v = 0; v < current.depth.rows; ++v)
    for (int u = 0; u < current.depth.cols; ++u) {
      const float z = current.depth.at<float>(v, u);
      if (z <= 0) continue;
      ++normal.pixels;
      const auto met = meet(reference, reference_from_current * current.camera.backProject(u, v, z), gate_m);
      if (!met) continue;
      ++normal.met;
      normal.add(pointDerivative(met->normal, met->point), met->normal.dot(met->point - met->on_surface),
                 depthSigma(z));
      addBrightness(reference, *met, current.brightness.at<float>(v, u), bias, normal);
    }
  return normal;
}

Pose3 movedBy(const Pose3& pose, const Vector6d& step) {
  Pose3 change = Pose3::Identity();
  change.linear() = expSO3(step.tail<3>());
  change.translation() = step.head<3>();
  return normalized(change * pose);
}

// Small change, in the reference's frame, that leads from one pose to the other.
Vector6d changeBetween(const Pose3& from, const Pose3& to) {
  const Pose3 change = to * from.inverse();
  Vector6d out;
  out << change.translation(), logSO3(change.linear());
  return out;
}

}  // namespace

std::optional<DenseAlignment> alignDense(const DenseImage& reference, const DenseImage& current,
                                         const DensePrior& prior) {
  Vector6d sigma;
  sigma << Eigen::Vector3d::Constant(prior.sigma_m), Eigen::Vector3d::Constant(prior.sigma_rad);
  const Matrix6d prior_information = sigma.cwiseAbs2().cwiseInverse().asDiagonal();
  DenseAlignment out{prior.reference_from_current};
  Normal normal;
  for (std::size_t level = reference.levels().size(); level-- > 0;) {
    const double gate_m = kGate_m * std::pow(kGatePerLevel, static_cast<double>(level));
    const double alike = kAlike / std::pow(4.0, static_cast<double>(level));
    double bias = 0;
    for (int i = 0; i < kIterations; ++i) {
      normal = linearise(reference.levels()[level], current.levels()[level], out.reference_from_current, gate_m, bias);
      if (normal.met < kLeastPixels / std::pow(4.0, static_cast<double>(level))) return std::nullopt;
      bias = normal.brightness.bias();
      const Matrix6d information = normal.information / alike + prior_information;
      const Vector6d to_prior = changeBetween(prior.reference_from_current, out.reference_from_current);
      const Vector6d step = -information.ldlt().solve(normal.gradient / alike + prior_information * to_prior);
      out.reference_from_current = movedBy(out.reference_from_current, step);
      if (step.norm() < kStill) break;
    }
  }
  out.overlap = static_cast<double>(normal.met) / std::max(1, normal.pixels);
  if (out.overlap < kLeastOverlap || !normal.brightness.isAlike()) return std::nullopt;
  out.covariance = (normal.information / kAlike + prior_information).inverse();
  return out;
}

}  // namespace roomgraph::tracking
