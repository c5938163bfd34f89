// SPDX-License-Identifier: BSD-3-Clause
// Levenberg-Marquardt on an interpolated grid, and the curvature of surfaces.
#include "grid_refinement.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace roomgraph {
namespace {

constexpr double kSurface = 0.5;  // cells at least this probable are surfaces
constexpr double kFree = 0.3;     // known cells below are free space
constexpr std::size_t kMostNormals = 1000;

void addPrior(const Pose2& pose, const PosePrior& prior, GridCost& cost) {
  const Eigen::Vector3d shift(pose.x - prior.pose.x, pose.y - prior.pose.y,
                              wrapAngle(pose.yaw - prior.pose.yaw));
  const Eigen::Vector3d weights(prior.weight_per_m2, prior.weight_per_m2, prior.weight_per_rad2);
  cost.value += shift.dot(weights.cwiseProduct(shift));
  cost.gradient += 2 * weights.cwiseProduct(shift);
  cost.curvature.diagonal() += weights;
  const Eigen::Vector2d pull = prior.extra_weight_per_m2 * shift.head<2>();
  cost.value += shift.head<2>().dot(pull);
  cost.gradient.head<2>() += 2 * pull;
  cost.curvature.topLeftCorner<2, 2>() += prior.extra_weight_per_m2;
}

// Of the points within a radius that grows with the range, as the returns get sparser.
Eigen::Matrix2d normalProjection(const Eigen::Vector2d& at, const Points2& points) {
  const double radius = std::max(0.3, 0.08 * at.norm());
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d square = Eigen::Matrix2d::Zero();
  int count = 0;
  for (const Eigen::Vector2d& p : points) {
    const Eigen::Vector2d offset = p - at;
    if (offset.squaredNorm() > radius * radius) continue;
    mean += offset;
    square += offset * offset.transpose();
    ++count;
  }
  if (count < 4) return Eigen::Matrix2d::Zero();  // alone: its direction says nothing
  mean /= count;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> spread(
      Eigen::Matrix2d(square / count - mean * mean.transpose()));
  const Eigen::Vector2d normal = spread.eigenvectors().col(0), along = spread.eigenvectors().col(1);
  const double roundness = spread.eigenvalues()[0] / std::max(1e-12, spread.eigenvalues()[1]);
  return normal * normal.transpose() + roundness * along * along.transpose();
}

void countAgreement(const ProbabilityGrid& grid, const Points2& points, GridRefinement& out) {
  for (const Eigen::Vector2d& p : transformed(out.grid_from_scan, points)) {
    // The brightest cell around: a return one cell beside its surface agrees with it.
    const Eigen::Vector2i cell = grid.cellOf(p);
    float brightest = 0;
    bool known = false;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        brightest = std::max(brightest, grid.at(cell.x() + dx, cell.y() + dy));
        known = known || grid.known(cell.x() + dx, cell.y() + dy);
      }
    out.explained += brightest >= kSurface;
    out.contradicted += known && brightest < kFree;
  }
  out.explained /= static_cast<double>(points.size());
  out.contradicted /= static_cast<double>(points.size());
}

}  // namespace

GridCost gridCost(const ProbabilityGrid& grid, const Points2& points, const Pose2& pose,
                  const PosePrior& prior) {
  GridCost cost;
  const double c = std::cos(pose.yaw), s = std::sin(pose.yaw);
  for (const Eigen::Vector2d& p : points) {
    const Eigen::Vector2d turned(c * p.x() - s * p.y(), s * p.x() + c * p.y());
    Eigen::Vector2d slope;
    const double residual = 1 - grid.interpolate(turned + Eigen::Vector2d(pose.x, pose.y), &slope);
    const Eigen::Vector3d jacobian(-slope.x(), -slope.y(), slope.x() * turned.y() - slope.y() * turned.x());
    cost.residual += residual * residual;
    cost.gradient += 2 * residual * jacobian;
    cost.curvature += jacobian * jacobian.transpose();
  }
  const double share = 1.0 / static_cast<double>(points.size());
  cost.residual *= share;
  cost.gradient *= share;
  cost.curvature *= share;
  cost.value = cost.residual;
  addPrior(pose, prior, cost);
  return cost;
}

Eigen::Matrix3d surfaceCurvature(const Points2& points, const Pose2& pose,
                                 const Eigen::Matrix3d& grid_curvature) {
  const Points2 turned = transformed({0, 0, pose.yaw}, points);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  // Only directions count: some points speak for all, or a map's returns would take the square of their number.
  const std::size_t stride = 1 + turned.size() / kMostNormals;
  for (std::size_t i = 0; i < turned.size(); i += stride) {
    const Eigen::Vector2d& p = turned[i];
    Eigen::Matrix<double, 2, 3> jacobian;
    jacobian << 1, 0, -p.y(), 0, 1, p.x();
    sum += jacobian.transpose() * normalProjection(p, turned) * jacobian;
  }
  const double size = sum(0, 0) + sum(1, 1);
  if (size <= 0) return grid_curvature;
  return sum * ((grid_curvature(0, 0) + grid_curvature(1, 1)) / size);
}

Eigen::Matrix2d placeCurvature(const Eigen::Matrix3d& curvature) {
  const Eigen::Vector2d mixed = curvature.topRightCorner<2, 1>();
  return curvature.topLeftCorner<2, 2>() - mixed * mixed.transpose() / std::max(1e-9, curvature(2, 2));
}

GridRefinement refineOnGrid(const ProbabilityGrid& grid, const Points2& points, const Pose2& start,
                            const PosePrior& prior, int max_iterations) {
  Pose2 pose = start;
  GridCost cost = gridCost(grid, points, pose, prior);
  double damping = 1e-3;
  for (int i = 0; i < max_iterations; ++i) {
    Eigen::Matrix3d damped = cost.curvature;
    damped.diagonal() += damping * (cost.curvature.diagonal() + Eigen::Vector3d::Constant(1e-6));
    const Eigen::Vector3d step = -0.5 * damped.ldlt().solve(cost.gradient);
    const Pose2 moved{pose.x + step.x(), pose.y + step.y(), wrapAngle(pose.yaw + step.z())};
    const GridCost next = gridCost(grid, points, moved, prior);
    if (next.value < cost.value) {
      pose = moved;
      cost = next;
      damping *= 0.2;
      if (step.head<2>().norm() < 1e-5 && std::abs(step.z()) < 1e-6) break;
    } else {
      damping *= 8;
      if (damping > 1e4) break;
    }
  }
  GridRefinement out;
  out.grid_from_scan = pose;
  const GridCost data = gridCost(grid, points, pose, PosePrior{});
  out.curvature = surfaceCurvature(points, pose, data.curvature) * static_cast<double>(points.size());
  out.mean_curvature = data.curvature;
  out.residual_variance = data.residual;
  countAgreement(grid, points, out);
  return out;
}

Eigen::Matrix3d poseCovariance(const GridRefinement& refinement, const CovarianceModel& model) {
  const double variance = refinement.residual_variance * model.inflation * model.inflation;
  const Eigen::Matrix3d information =
      refinement.curvature / variance + Eigen::Matrix3d::Identity() / (model.max_sigma * model.max_sigma);
  Eigen::Matrix3d covariance = information.inverse();
  covariance(0, 0) += model.floor_sigma_m * model.floor_sigma_m;
  covariance(1, 1) += model.floor_sigma_m * model.floor_sigma_m;
  covariance(2, 2) += model.floor_sigma_rad * model.floor_sigma_rad;
  return 0.5 * (covariance + covariance.transpose());
}

}  // namespace roomgraph
