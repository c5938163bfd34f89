// SPDX-License-Identifier: BSD-3-Clause
// Residuals, weights and Gauss-Newton steps of dense alignment.
#include "dense_alignment.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace roomgraph::tracking {
namespace {

constexpr int kIterations = 12;
constexpr int kLeastPixels = 150;
constexpr double kLeastOverlap = 0.25;
constexpr double kStill = 1e-5;               // m, rad
constexpr double kGate_m = 0.15, kGatePerLevel = 2;  // coarser levels allow for more
constexpr double kBrightnessSigma = 3;  // grey levels
constexpr double kLooseAtFirst = 4;
constexpr double kTightens = 0.7;  // from one iteration to the next
constexpr double kForgotten = 3;  // standard deviations: what errs by more hardly counts (Geman-McClure)
// Less is noise, which would tie the images to each other.
constexpr double kLeastSlope = 0.7;  // grey levels per px
// Where both images have contrast, they must look alike: another place has the same walls.
constexpr double kContrast = 1, kLeastCorrelation = 0.5;
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
  double loose;  ///< factor on what may err
  Likeness brightness;

  double weightOf(double residual, double sigma) const {
    const double size = residual / (loose * kForgotten * sigma);
    const double robust = 1 / (1 + size * size);
    return robust * robust / (sigma * sigma);
  }
  void add(const Vector6d& derivative, double residual, double weight) {
    information += weight * derivative * derivative.transpose();
    gradient += weight * residual * derivative;
  }
};

// A point of the current image in the reference's frame, and the pixel there.
struct Met {
  Eigen::Vector3d point, on_surface, normal;
  double normal_variance;
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
  const Met met{point, reference.camera.backProject(u, v, z), {n[0], n[1], n[2]},
                reference.normal_variance.at<float>(v, u), u, v};
  if (std::abs(met.normal.dot(point - met.on_surface)) > gate_m) return std::nullopt;
  return met;
}

// Of (translation, rotation) of the point about the reference's origin.
Vector6d pointDerivative(const Eigen::Vector3d& by_point, const Eigen::Vector3d& point) {
  Vector6d out;
  out << by_point, point.cross(by_point);
  return out;
}

// Normals scatter about that of a wall, which looks as if it held along the wall, too: so much of it is taken off.
void addDistance(const Met& met, double sigma, Normal& normal) {
  const double residual = met.normal.dot(met.point - met.on_surface), weight = normal.weightOf(residual, sigma);
  normal.add(pointDerivative(met.normal, met.point), residual, weight);
  Eigen::Matrix<double, 6, 3> by_normal;
  by_normal.topRows<3>().setIdentity();
  by_normal.bottomRows<3>() = Eigen::Matrix3d::Identity().colwise().cross(Eigen::Vector3d(-met.point));
  const Eigen::Matrix3d scatter = Eigen::Matrix3d::Identity() - met.normal * met.normal.transpose();
  normal.information -= weight * met.normal_variance * by_normal * scatter * by_normal.transpose();
}

void addBrightness(const DenseLevel& reference, const Met& met, const DenseLevel& current, int u, int v, Normal& normal) {
  const double brightness = current.brightness.at<float>(v, u), there = reference.brightness.at<float>(met.v, met.u), difference = there - brightness;
  normal.brightness.add(there, brightness);
  const double sx = reference.slope_x.at<float>(met.v, met.u), sy = reference.slope_y.at<float>(met.v, met.u);
  // An edge that only one of them shows is hidden, or lies beyond the other's border.
  const double least = std::min(std::hypot(sx, sy), double{std::hypot(current.slope_x.at<float>(v, u), current.slope_y.at<float>(v, u))});
  if (least < kLeastSlope) return;
  const PinholeCamera& camera = reference.camera;
  const Eigen::Vector3d& p = met.point;
  const Eigen::Vector2d pixel = camera.project(p);
  // To the place between the pixels.
  const double between = sx * (pixel.x() - met.u) + sy * (pixel.y() - met.v);
  const Eigen::Vector3d by_point(sx * camera.fx / p.z(), sy * camera.fy / p.z(),
                                 -(sx * camera.fx * p.x() + sy * camera.fy * p.y()) / (p.z() * p.z()));
  const double residual = difference + between;
  normal.add(pointDerivative(by_point, p), residual, normal.weightOf(residual, kBrightnessSigma));
}

Normal linearise(const DenseLevel& reference, const DenseLevel& current, const Pose3& reference_from_current,
                 double gate_m, double loose) {
  Normal normal{.loose = loose};
  for (int v = 0; v < current.depth.rows; ++v)
    for (int u = 0; u < current.depth.cols; ++u) {
      const float z = current.depth.at<float>(v, u);
      if (z <= 0) continue;
      ++normal.pixels;
      const auto met = meet(reference, reference_from_current * current.camera.backProject(u, v, z), gate_m);
      if (!met) continue;
      ++normal.met;
      addDistance(*met, depthSigma(z), normal);
      addBrightness(reference, *met, current, u, v, normal);
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

Matrix6d positivePart(const Matrix6d& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> parts(symmetric);
  return parts.eigenvectors() * parts.eigenvalues().cwiseMax(0).asDiagonal() * parts.eigenvectors().transpose();
}

// From small changes in the reference's frame to the axes that the prior speaks of.
Matrix6d toAxes(const DensePrior& prior) {
  if (!prior.current_from_body) return Matrix6d::Identity();
  return adjoint((prior.reference_from_current * *prior.current_from_body).inverse());
}

}  // namespace

Vector6d sameInAllDirections(double sigma_m, double sigma_rad) {
  Vector6d out;
  out << Eigen::Vector3d::Constant(sigma_m), Eigen::Vector3d::Constant(sigma_rad);
  return out;
}

Matrix6d adjoint(const Pose3& a_from_b) {
  Matrix6d out = Matrix6d::Zero();
  const Eigen::Matrix3d turn = a_from_b.linear();
  out.topLeftCorner<3, 3>() = out.bottomRightCorner<3, 3>() = turn;
  for (int i = 0; i < 3; ++i) out.topRightCorner<3, 3>().col(i) = a_from_b.translation().cross(turn.col(i));
  return out;
}

std::optional<DenseAlignment> alignDense(const DenseImage& reference, const DenseImage& current,
                                         const DensePrior& prior) {
  const Matrix6d to_axes = toAxes(prior), in_sigmas = prior.sigma.cwiseInverse().asDiagonal() * to_axes;
  const Matrix6d predicted = in_sigmas.transpose() * in_sigmas;
  DenseAlignment out{prior.reference_from_current};
  Normal normal{};
  double loose = kLooseAtFirst;
  for (std::size_t level = reference.levels().size(); level-- > 0;) {
    const double gate_m = kGate_m * std::pow(kGatePerLevel, static_cast<double>(level));
    const double alike = kAlike / std::pow(4.0, static_cast<double>(level));
    for (int i = 0; i < kIterations; ++i) {
      normal = linearise(reference.levels()[level], current.levels()[level], out.reference_from_current, gate_m, loose);
      if (normal.met < kLeastPixels / std::pow(4.0, static_cast<double>(level))) return std::nullopt;
      const Matrix6d information = positivePart(normal.information) / alike + predicted;
      const Vector6d to_prior = changeBetween(prior.reference_from_current, out.reference_from_current);
      const Vector6d step = -information.ldlt().solve(normal.gradient / alike + predicted * to_prior);
      out.reference_from_current = movedBy(out.reference_from_current, step);
      if (step.norm() < kStill && loose == 1) break;
      loose = std::max(1.0, kTightens * loose);
    }
  }
  out.overlap = static_cast<double>(normal.met) / std::max(1, normal.pixels);
  const Vector6d unexpected = to_axes * changeBetween(prior.reference_from_current, out.reference_from_current);
  const bool plausible = unexpected.head<3>().norm() <= prior.plausible_m && unexpected.tail<3>().norm() <= prior.plausible_rad;
  if (out.overlap < kLeastOverlap || !plausible || !normal.brightness.isAlike()) return std::nullopt;
  const Matrix6d unseen = prior.unseen.cwiseInverse().asDiagonal() * to_axes;
  out.covariance = (positivePart(normal.information) / kAlike + unseen.transpose() * unseen).inverse();
  return out;
}

}  // namespace roomgraph::tracking
