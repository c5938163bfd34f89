// SPDX-License-Identifier: BSD-3-Clause
// Robust Levenberg-Marquardt on pixel and depth residuals, inlier classification, PnP.
#include "pose_solver.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>

namespace roomgraph::tracking {
namespace {

constexpr double kChi2Pixel = 5.991;  // 95 %, 2 degrees of freedom
constexpr double kOtherSurface = 10;  // sigma of depth
constexpr double kMinDepth = 0.05;    // m, nearer points have no usable projection
constexpr double kHuber = 1.5;        // sigma
constexpr double kCauchy = 2.0;       // sigma

struct NormalEquations {
  Matrix6d hessian = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  double cost = 0;
};

// The derivative of the deviation by a perturbation is nearly the identity over the standard deviations.
void addPrior(const PosePrior& prior, const Pose3& pose, NormalEquations& out) {
  const Vector6d deviation = prior.deviation(pose), weights = prior.sigmas().cwiseInverse();
  out.cost += deviation.squaredNorm();
  out.hessian.diagonal() += weights.cwiseAbs2();
  out.gradient += weights.cwiseProduct(deviation);
}

/// Huber on the pixel, Cauchy on the depth: depth at an edge may be off by any amount while the pixel is
/// right.
NormalEquations linearize(const PoseProblem& problem, const std::vector<char>& use, const Pose3& pose) {
  NormalEquations out;
  if (problem.prior) addPrior(*problem.prior, pose, out);
  for (std::size_t i = 0; i < problem.points.size(); ++i) {
    if (!use[i]) continue;
    const Eigen::Vector3d p = pose * problem.points[i];
    if (p.z() < kMinDepth) {
      out.cost += 100;
      continue;
    }
    Eigen::Vector3d r;
    reprojectionResidual(problem.camera, problem.observations[i], p.data(), r.data());
    const double e = r.head<2>().norm(), d = r.z() * r.z() / (kCauchy * kCauchy);
    const double pixel_weight = e <= kHuber ? 1 : kHuber / e, depth_weight = 1 / (1 + d);
    out.cost += (e <= kHuber ? e * e : 2 * kHuber * e - kHuber * kHuber) + kCauchy * kCauchy * std::log1p(d);
    const auto jacobian = reprojectionJacobian(problem.camera, problem.observations[i], p);
    const Eigen::Vector3d weights(pixel_weight, pixel_weight, depth_weight);
    out.hessian.noalias() += jacobian.transpose() * weights.asDiagonal() * jacobian;
    out.gradient.noalias() += jacobian.transpose() * weights.cwiseProduct(r);
  }
  return out;
}

Pose3 minimize(const PoseProblem& problem, const std::vector<char>& use, Pose3 pose) {
  double lambda = 1e-4;
  NormalEquations current = linearize(problem, use, pose);
  for (int iteration = 0; iteration < 10; ++iteration) {
    Matrix6d damped = current.hessian;
    damped.diagonal() += lambda * (current.hessian.diagonal() + Vector6d::Constant(1e-6));
    const Vector6d step = -damped.ldlt().solve(current.gradient);
    if (!step.allFinite()) break;
    const Pose3 trial = normalized(leftPerturbation(step) * pose);
    const NormalEquations next = linearize(problem, use, trial);
    if (next.cost < current.cost) {
      pose = trial;
      current = next;
      lambda = std::max(lambda / 10, 1e-9);
      if (step.norm() < 1e-7) break;
    } else {
      lambda *= 10;
      if (lambda > 1e6) break;
    }
  }
  return pose;
}

void classify(const PoseProblem& problem, PoseSolution& solution) {
  const std::vector<double> errors = pixelErrors(problem, solution.camera_from_world);
  std::transform(errors.begin(), errors.end(), solution.inlier.begin(), agrees);
  solution.inliers = static_cast<int>(std::count(solution.inlier.begin(), solution.inlier.end(), 1));
}

}  // namespace

Vector6d PosePrior::sigmas() const {
  Vector6d out;
  out << Eigen::Vector3d::Constant(sigma_m), Eigen::Vector3d::Constant(sigma_rad);
  return out;
}

Vector6d PosePrior::deviation(const Pose3& other_from_world) const {
  const Pose3 difference = other_from_world * camera_from_world.inverse();
  Vector6d out;
  out << difference.translation(), logSO3(difference.linear());
  return out.cwiseQuotient(sigmas());
}

double deviationFrom(const PosePrior& prior, const PoseSolution& solution) {
  const Vector6d sigma = prior.sigmas(), deviation = prior.deviation(solution.camera_from_world);
  const Matrix6d covariance = Matrix6d::Identity() + Matrix6d(sigma.cwiseInverse().asDiagonal() * solution.covariance * sigma.cwiseInverse().asDiagonal());
  return std::sqrt(deviation.dot(covariance.llt().solve(deviation)));
}

std::vector<double> pixelErrors(const PoseProblem& problem, const Pose3& camera_from_world) {
  std::vector<double> out(problem.points.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < problem.points.size(); ++i) {
    const Eigen::Vector3d p = camera_from_world * problem.points[i];
    if (p.z() <= kMinDepth) continue;
    Eigen::Vector3d r;
    reprojectionResidual(problem.camera, problem.observations[i], p.data(), r.data());
    // The pixel decides; a depth 10 sigma off still means another surface.
    if (std::abs(r.z()) < kOtherSurface) out[i] = r.head<2>().squaredNorm();
  }
  return out;
}

bool agrees(double squared_error) { return squared_error < kChi2Pixel; }

PoseSolution refinePose(const PoseProblem& problem, const Pose3& camera_from_world, bool start_is_good) {
  PoseSolution solution;
  solution.camera_from_world = camera_from_world;
  solution.inlier.assign(problem.points.size(), 1);
  if (start_is_good) classify(problem, solution);
  for (int round = 0; round < 4; ++round) {
    solution.camera_from_world = minimize(problem, solution.inlier, solution.camera_from_world);
    classify(problem, solution);
    if (solution.inliers < 6) return solution;
  }
  const auto normal = linearize(problem, solution.inlier, solution.camera_from_world);
  const Matrix6d regular = normal.hessian + 1e-6 * Matrix6d::Identity();
  solution.covariance = regular.ldlt().solve(Matrix6d::Identity());
  return solution;
}

PoseSolution ransacPose(const PoseProblem& problem, int min_inliers) {
  PoseSolution none;
  none.inlier.assign(problem.points.size(), 0);
  if (static_cast<int>(problem.points.size()) < std::max(6, min_inliers)) return none;
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> pixels;
  for (std::size_t i = 0; i < problem.points.size(); ++i) {
    const auto& p = problem.points[i];
    points.emplace_back(p.x(), p.y(), p.z());
    pixels.emplace_back(problem.observations[i].pixel.x(), problem.observations[i].pixel.y());
  }
  const auto& k = problem.camera;
  const cv::Matx33d matrix(k.fx, 0, k.cx, 0, k.fy, k.cy, 0, 0, 1);
  cv::Mat rotation, translation;
  std::vector<int> chosen;
  // cv::solvePnPRansac draws from a generator of its own with a fixed seed: same input, same result.
  if (!cv::solvePnPRansac(points, pixels, matrix, cv::noArray(), rotation, translation, false, 200, 4.F, 0.99,
                          chosen, cv::SOLVEPNP_AP3P) ||
      static_cast<int>(chosen.size()) < std::max(6, min_inliers / 2))
    return none;
  Pose3 pose = Pose3::Identity();
  pose.linear() = expSO3({rotation.at<double>(0), rotation.at<double>(1), rotation.at<double>(2)});
  pose.translation() << translation.at<double>(0), translation.at<double>(1), translation.at<double>(2);
  PoseProblem agreed{problem.camera, {}, {}};
  for (const int i : chosen) {
    agreed.points.push_back(problem.points[static_cast<std::size_t>(i)]);
    agreed.observations.push_back(problem.observations[static_cast<std::size_t>(i)]);
  }
  return refinePose(problem, refinePose(agreed, pose).camera_from_world, true);
}

}  // namespace roomgraph::tracking
