// SPDX-License-Identifier: BSD-3-Clause
// Normal equations by blocks, elimination of the points, and damping.
#include "sparse_bundle.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace roomgraph::tracking {
namespace {

constexpr double kLeastRange_m = 0.05;  // nearer to the camera's plane nothing is seen
constexpr double kFirstDamping = 1e-4, kLeastDamping = 1e-10, kMostDamping = 1e6;
constexpr double kDampingStep = 10;
constexpr double kLeastDiagonal = 1e-6;  // of what is damped

using Coupling = Eigen::Matrix<double, 6, 3>;

/// A quadratic model of the cost around the present state, by blocks.
struct NormalBlocks {
  std::vector<Matrix6d> camera_hessian;  // per camera that moves, in their order
  std::vector<Vector6d> camera_gradient;
  std::vector<Eigen::Matrix3d> point_hessian;
  std::vector<Eigen::Vector3d> point_gradient;
  std::vector<Coupling> coupling;  // per term, point by point; of cameras that do not move undefined
};

/// Index among the cameras that move, else -1.
std::vector<int> columnsOf(const SparseBundle& bundle) {
  std::vector<int> columns;
  int next = 0;
  for (const BundleCamera& camera : bundle.cameras) columns.push_back(camera.moves ? next++ : -1);
  return columns;
}

/// Whitened residual, and the point in the camera's frame; false when it is behind the camera.
bool residualOf(const BundleCamera& camera, const Observation& observation, const Eigen::Vector3d& position,
                Eigen::Vector3d& in_camera, Eigen::Vector3d& residual) {
  in_camera = camera.camera_from_odom * position;
  if (in_camera.z() < kLeastRange_m) return false;
  reprojectionResidual(camera.intrinsics, observation, in_camera.data(), residual.data());
  return true;
}

// Cameras see the points that they are built with: none is behind them here.
NormalBlocks quadraticModel(const SparseBundle& bundle, const std::vector<int>& columns, std::size_t moving, double huber) {
  NormalBlocks out;
  out.camera_hessian.assign(moving, Matrix6d::Zero());
  out.camera_gradient.assign(moving, Vector6d::Zero());
  out.point_hessian.assign(bundle.points.size(), Eigen::Matrix3d::Zero());
  out.point_gradient.assign(bundle.points.size(), Eigen::Vector3d::Zero());
  Eigen::Vector3d in_camera, residual;
  for (std::size_t p = 0; p < bundle.points.size(); ++p)
    for (const BundleTerm& term : bundle.points[p].terms) {
      const BundleCamera& camera = bundle.cameras[static_cast<std::size_t>(term.camera)];
      residualOf(camera, term.observation, bundle.points[p].position, in_camera, residual);
      const double norm = residual.norm(), weight = norm <= huber ? 1 : huber / norm;
      const Eigen::Matrix<double, 3, 6> by_camera = reprojectionJacobian(camera.intrinsics, term.observation, in_camera);
      const Eigen::Matrix3d by_point = by_camera.leftCols<3>() * camera.camera_from_odom.linear();
      out.point_hessian[p].noalias() += weight * by_point.transpose() * by_point;
      out.point_gradient[p].noalias() += weight * by_point.transpose() * residual;
      Coupling& coupling = out.coupling.emplace_back();
      const int column = columns[static_cast<std::size_t>(term.camera)];
      if (column < 0) continue;
      const auto c = static_cast<std::size_t>(column);
      out.camera_hessian[c].noalias() += weight * by_camera.transpose() * by_camera;
      out.camera_gradient[c].noalias() += weight * by_camera.transpose() * residual;
      coupling.noalias() = weight * by_camera.transpose() * by_point;
    }
  return out;
}

template <class Matrix>
Matrix damped(const Matrix& hessian, double damping) {
  Matrix out = hessian;
  out.diagonal() += damping * hessian.diagonal().cwiseMax(kLeastDiagonal);
  return out;
}

struct Step {
  Eigen::VectorXd cameras;  // (translation, rotation) of each that moves
  std::vector<Eigen::Vector3d> points;
  bool finite = false;
};

/// Minimum of the damped model: the points are eliminated, the cameras solved for, the points found from these.
Step minimumOf(const NormalBlocks& blocks, const SparseBundle& bundle, const std::vector<int>& columns, double damping) {
  const auto moving = static_cast<Eigen::Index>(blocks.camera_hessian.size());
  Eigen::MatrixXd reduced = Eigen::MatrixXd::Zero(6 * moving, 6 * moving);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(6 * moving);
  for (Eigen::Index c = 0; c < moving; ++c) {
    const auto i = static_cast<std::size_t>(c);
    reduced.block<6, 6>(6 * c, 6 * c) = damped(blocks.camera_hessian[i], damping);
    right.segment<6>(6 * c) = -blocks.camera_gradient[i];
  }
  std::vector<Eigen::Matrix3d> inverse(bundle.points.size());
  std::size_t first = 0;  // term of the point
  for (std::size_t p = 0; p < bundle.points.size(); ++p) {
    const auto& terms = bundle.points[p].terms;
    inverse[p] = damped(blocks.point_hessian[p], damping).inverse();
    for (std::size_t i = 0; i < terms.size(); ++i) {
      const int row = columns[static_cast<std::size_t>(terms[i].camera)];
      if (row < 0) continue;
      const Coupling gained = blocks.coupling[first + i] * inverse[p];
      right.segment<6>(6 * row).noalias() += gained * blocks.point_gradient[p];
      for (std::size_t j = 0; j < terms.size(); ++j) {
        const int column = columns[static_cast<std::size_t>(terms[j].camera)];
        if (column < 0 || column > row) continue;  // the lower triangle is enough
        reduced.block<6, 6>(6 * row, 6 * column).noalias() -= gained * blocks.coupling[first + j].transpose();
      }
    }
    first += terms.size();
  }
  Step step;
  step.cameras = reduced.selfadjointView<Eigen::Lower>().ldlt().solve(right);
  step.finite = step.cameras.allFinite();
  first = 0;
  for (std::size_t p = 0; p < bundle.points.size(); ++p) {
    Eigen::Vector3d pull = blocks.point_gradient[p];
    for (const BundleTerm& term : bundle.points[p].terms) {
      const int column = columns[static_cast<std::size_t>(term.camera)];
      if (column >= 0) pull.noalias() += blocks.coupling[first].transpose() * step.cameras.segment<6>(6 * column);
      ++first;
    }
    step.points.emplace_back(-inverse[p] * pull);
    step.finite = step.finite && step.points.back().allFinite();
  }
  return step;
}

/// What changes.
struct BundleState {
  std::vector<Pose3> poses;
  std::vector<Eigen::Vector3d> positions;
};

BundleState stateOf(const SparseBundle& bundle) {
  BundleState state;
  for (const BundleCamera& camera : bundle.cameras) state.poses.push_back(camera.camera_from_odom);
  for (const BundlePoint& point : bundle.points) state.positions.push_back(point.position);
  return state;
}

void restore(SparseBundle& bundle, const BundleState& state) {
  for (std::size_t c = 0; c < bundle.cameras.size(); ++c) bundle.cameras[c].camera_from_odom = state.poses[c];
  for (std::size_t p = 0; p < bundle.points.size(); ++p) bundle.points[p].position = state.positions[p];
}

void take(SparseBundle& bundle, const std::vector<int>& columns, const Step& step) {
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (columns[c] < 0) continue;
    Pose3& pose = bundle.cameras[c].camera_from_odom;
    pose = normalized(leftPerturbation(step.cameras.segment<6>(6 * columns[c])) * pose);
  }
  for (std::size_t p = 0; p < bundle.points.size(); ++p) bundle.points[p].position += step.points[p];
}

}  // namespace

double costOf(const SparseBundle& bundle, double huber) {
  double cost = 0;
  Eigen::Vector3d in_camera, residual;
  for (const BundlePoint& point : bundle.points)
    for (const BundleTerm& term : point.terms) {
      const BundleCamera& camera = bundle.cameras[static_cast<std::size_t>(term.camera)];
      if (!residualOf(camera, term.observation, point.position, in_camera, residual))
        return std::numeric_limits<double>::infinity();
      const double norm = residual.norm();
      cost += norm <= huber ? norm * norm : 2 * huber * norm - huber * huber;
    }
  return cost / 2;
}

bool adjust(SparseBundle& bundle, const BundleOptions& options) {
  const std::vector<int> columns = columnsOf(bundle);
  const auto moving = std::count_if(columns.begin(), columns.end(), [](int column) { return column >= 0; });
  double cost = costOf(bundle, options.huber), damping = kFirstDamping;
  if (!std::isfinite(cost)) return false;
  NormalBlocks blocks = quadraticModel(bundle, columns, static_cast<std::size_t>(moving), options.huber);
  for (int iteration = 0; iteration < options.max_iterations && damping < kMostDamping; ++iteration) {
    const Step step = minimumOf(blocks, bundle, columns, damping);
    const BundleState before = stateOf(bundle);
    if (step.finite) take(bundle, columns, step);
    const double next = step.finite ? costOf(bundle, options.huber) : std::numeric_limits<double>::infinity();
    if (!(next < cost)) {
      restore(bundle, before);
      damping *= kDampingStep;
      continue;
    }
    const bool done = cost - next < options.tolerance * cost;
    cost = next;
    if (done) break;
    damping = std::max(damping / kDampingStep, kLeastDamping);
    blocks = quadraticModel(bundle, columns, static_cast<std::size_t>(moving), options.huber);
  }
  return true;
}

}  // namespace roomgraph::tracking
