// SPDX-License-Identifier: BSD-3-Clause
// Change of variables between rotation vectors and Euler angles in covariances of relative poses.
#include "roomgraph/graphslam/constraints.h"

#include <Eigen/Eigenvalues>

#include "roomgraph/geometry/covariance.h"

namespace roomgraph {
namespace {

constexpr double kLeastInformation = 1e-9, kUnmeasuredVariance = 0.25;

// Inverse of a symmetric matrix whose eigenvalues are raised to `least` at least.
template <int N>
Eigen::Matrix<double, N, N> inverseOf(const Eigen::Matrix<double, N, N>& matrix, double least) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>> solver((matrix + matrix.transpose()) / 2);
  const auto values = solver.eigenvalues().cwiseMax(least).cwiseInverse().eval();
  return solver.eigenvectors() * values.asDiagonal() * solver.eigenvectors().transpose();
}

// Movement's (translation, rotation vector) by MRPT's (x, y, z, yaw, pitch, roll).
Matrix6d byParameters(const mrpt::poses::CPose3D& mean) {
  Matrix6d out = Matrix6d::Identity();
  out.bottomRightCorner<3, 3>() = rotationByYawPitchRoll(mean.pitch(), mean.roll());
  return out;
}

}  // namespace

Eigen::Matrix3d rotationByYawPitchRoll(double pitch, double roll) {
  const double cp = std::cos(pitch), sp = std::sin(pitch), cr = std::cos(roll), sr = std::sin(roll);
  Eigen::Matrix3d out;
  out << -sp, 0, 1,  //
      cp * sr, cr, 0,  //
      cp * cr, -sr, 0;
  return out;
}

void toConstraint(const Movement& movement, mrpt::poses::CPosePDFGaussianInf& constraint) {
  const Pose2 mean = planarPart(movement.a_from_b);
  Eigen::Matrix3d covariance;
  const int index[3] = {0, 1, 5};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) covariance(i, j) = movement.covariance(index[i], index[j]);
  constraint.mean = mrpt::poses::CPose2D(mean.x, mean.y, mean.yaw);
  constraint.cov_inv.asEigen() = inverseOf<3>(covariance, 0);
}

void toConstraint(const Movement& movement, mrpt::poses::CPose3DPDFGaussianInf& constraint) {
  constraint.mean = toMrpt(movement.a_from_b);
  const Matrix6d by = byParameters(constraint.mean);
  constraint.cov_inv.asEigen() = by.transpose() * inverseOf<6>(movement.covariance, 0) * by;
}

Movement toMovement(const mrpt::poses::CPosePDFGaussianInf& constraint) {
  const auto& mean = constraint.mean;
  const Eigen::Matrix3d information = constraint.cov_inv.asEigen();
  return {toPose3(Pose2{mean.x(), mean.y(), mean.phi()}),
          planarCovariance(inverseOf<3>(information, kLeastInformation), kUnmeasuredVariance)};
}

Movement toMovement(const mrpt::poses::CPose3DPDFGaussianInf& constraint) {
  const Matrix6d information = constraint.cov_inv.asEigen();
  const Matrix6d by = byParameters(constraint.mean);
  return {toPose3(constraint.mean), by * inverseOf<6>(information, kLeastInformation) * by.transpose()};
}

}  // namespace roomgraph
