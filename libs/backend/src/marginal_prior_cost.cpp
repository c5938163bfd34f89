// SPDX-License-Identifier: BSD-3-Clause
// Residual and analytic Jacobian of a marginal prior, with rotation vectors of quaternions.
#include "marginal_prior_cost.h"

#include <ceres/jet.h>

#include <cmath>
#include <stdexcept>

#include "roomgraph/geometry/shape_math.h"

namespace roomgraph {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Rotation vector of q * from⁻¹, the short way round; quaternions (x, y, z, w).
template <class T>
void turnSince(const Eigen::Quaterniond& from, const T* q, T* out) {
  using std::atan2, std::sqrt;
  Eigen::Quaternion<T> turn = Eigen::Map<const Eigen::Quaternion<T>>(q) * from.conjugate().cast<T>();
  if (turn.w() < T(0)) turn.coeffs() = -turn.coeffs();
  const T square = turn.vec().squaredNorm();
  // Angle over sine of half the angle; below this the series 2 / w is exact.
  const T scale =
      square < T(1e-20) ? T(T(2) / turn.w()) : T(T(2) * atan2(T(sqrt(square)), turn.w()) / sqrt(square));
  for (int i = 0; i < 3; ++i) out[i] = scale * turn.vec()[i];
}

Eigen::Matrix<double, 3, 4> turnDerivative(const Eigen::Quaterniond& from, const double* q) {
  using Jet = ceres::Jet<double, 4>;
  Jet in[4], out[3];
  for (int i = 0; i < 4; ++i) in[i] = Jet(q[i], i);
  turnSince(from, in, out);
  Eigen::Matrix<double, 3, 4> derivative;
  for (int i = 0; i < 3; ++i) derivative.row(i) = out[i].v.transpose();
  return derivative;
}

double wrapped(double angle) {
  return std::atan2(std::sin(angle), std::cos(angle));
}

void set(double* jacobian, const Eigen::MatrixXd& value) {
  if (jacobian) Eigen::Map<RowMajor>(jacobian, value.rows(), value.cols()) = value;
}

}  // namespace

MarginalPriorCost::MarginalPriorCost(const MarginalPrior& prior) : prior_(prior) {
  const auto& v = prior.variables;
  const auto columns =
      static_cast<Eigen::Index>(kPoseTangent * v.nodes.size() + kLandmarkTangent * v.landmarks.size() +
                                kPointTangent * v.points.size());
  if (v.nodes.size() != prior.poses.size() || v.landmarks.size() != prior.landmarks.size() ||
      v.points.size() != prior.points.size() || prior.root.cols() != columns ||
      prior.root.rows() != prior.offset.size() || prior.offset.size() == 0)
    throw std::invalid_argument("marginal prior: variables, estimates, root and offset differ in size");
  for (const auto& pose : prior.poses) {
    rotations_.emplace_back(pose.linear());
    mutable_parameter_block_sizes()->insert(mutable_parameter_block_sizes()->end(), {3, 4});
  }
  for (std::size_t i = 0; i < v.landmarks.size(); ++i)
    mutable_parameter_block_sizes()->insert(mutable_parameter_block_sizes()->end(), {4, 3});
  for (std::size_t i = 0; i < v.points.size(); ++i) mutable_parameter_block_sizes()->push_back(3);
  set_num_residuals(static_cast<int>(prior.offset.size()));
}

Eigen::VectorXd MarginalPriorCost::difference(double const* const* blocks) const {
  using Map3 = Eigen::Map<const Eigen::Vector3d>;
  Eigen::VectorXd d(prior_.root.cols());
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < prior_.poses.size(); ++i, blocks += 2, row += kPoseTangent) {
    d.segment<3>(row) = Map3(blocks[0]) - prior_.poses[i].translation();
    turnSince(rotations_[i], blocks[1], d.data() + row + 3);
  }
  for (const auto& landmark : prior_.landmarks) {
    d.segment<3>(row) = Map3(blocks[0]) - landmark.position;
    d[row + 3] = wrapped(blocks[0][3] - landmark.yaw);
    d.segment<3>(row + 4) = Map3(blocks[1]) - sizeOf(landmark.shape);
    blocks += 2;
    row += kLandmarkTangent;
  }
  for (const auto& point : prior_.points) {
    d.segment<3>(row) = Map3(*blocks++) - point;
    row += kPointTangent;
  }
  return d;
}

bool MarginalPriorCost::Evaluate(double const* const* blocks, double* residuals, double** jacobians) const {
  const Eigen::MatrixXd& root = prior_.root;
  Eigen::Map<Eigen::VectorXd>(residuals, root.rows()) = root * difference(blocks) + prior_.offset;
  if (!jacobians) return true;
  Eigen::Index column = 0;
  for (std::size_t i = 0; i < rotations_.size(); ++i, blocks += 2, column += kPoseTangent) {
    set(*jacobians++, root.middleCols<3>(column));
    set(*jacobians++, root.middleCols<3>(column + 3) * turnDerivative(rotations_[i], blocks[1]));
  }
  for (std::size_t i = 0; i < prior_.landmarks.size(); ++i, column += kLandmarkTangent) {
    set(*jacobians++, root.middleCols<4>(column));
    set(*jacobians++, root.middleCols<3>(column + 4));
  }
  for (std::size_t i = 0; i < prior_.points.size(); ++i, column += kPointTangent)
    set(*jacobians++, root.middleCols<3>(column));
  return true;
}

}  // namespace roomgraph
