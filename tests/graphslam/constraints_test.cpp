// SPDX-License-Identifier: BSD-3-Clause
// Constraints of MRPT's networks: Euler angles against finite differences, information against samples.
#include "roomgraph/graphslam/constraints.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>

namespace roomgraph {
namespace {

const Pose3 kMovement = poseFromYpr(0.4, -0.2, 0.1, 0.7, -0.3, 0.5);

Matrix6d someCovariance(double scale) {
  Matrix6d root;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> entry(-1, 1);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) root(i, j) = entry(random);
  return scale * (root * root.transpose() + Matrix6d::Identity());
}

TEST(Constraints, AnglesTurnAsFiniteDifferencesSay) {
  const double yaw = 0.7, pitch = -0.3, roll = 0.5, step = 1e-6;
  const Eigen::Matrix3d columns = rotationByYawPitchRoll(pitch, roll), base = poseFromYpr(0, 0, 0, yaw, pitch, roll).linear();
  const double changes[3][3] = {{step, 0, 0}, {0, step, 0}, {0, 0, step}};
  for (int i = 0; i < 3; ++i) {
    const double* d = changes[i];
    const Eigen::Matrix3d turned = poseFromYpr(0, 0, 0, yaw + d[0], pitch + d[1], roll + d[2]).linear();
    EXPECT_LT((columns.col(i) - logSO3(base.transpose() * turned) / step).norm(), 1e-5) << i;
  }
}

// Parameters of samples of the movement scatter as the constraint says.
TEST(Constraints, InformationIsThatOfSampledParameters) {
  const Movement movement{kMovement, someCovariance(1e-5)};
  mrpt::poses::CPose3DPDFGaussianInf constraint;
  toConstraint(movement, constraint);
  const Matrix6d root = movement.covariance.llt().matrixL();
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const int samples = 40000;
  Matrix6d scatter = Matrix6d::Zero();
  for (int k = 0; k < samples; ++k) {
    Vector6d draw;
    for (int i = 0; i < 6; ++i) draw[i] = normal(random);
    draw = root * draw;
    Pose3 sample = kMovement;
    sample.translation() += draw.head<3>();
    sample.linear() = kMovement.linear() * expSO3(draw.tail<3>());
    const auto at = toMrpt(sample);
    Vector6d off;
    for (int i = 0; i < 6; ++i) off[i] = at[static_cast<std::size_t>(i)] - constraint.mean[static_cast<std::size_t>(i)];
    scatter += off * off.transpose() / samples;
  }
  const Matrix6d told = constraint.cov_inv.asEigen().inverse();
  EXPECT_LT((scatter - told).norm(), 0.05 * told.norm());
}

TEST(Constraints, SpatialMovementsComeBack) {
  const Movement movement{kMovement, someCovariance(1e-3)};
  mrpt::poses::CPose3DPDFGaussianInf constraint;
  toConstraint(movement, constraint);
  const Movement back = toMovement(constraint);
  EXPECT_TRUE(back.a_from_b.isApprox(movement.a_from_b, 1e-9));
  EXPECT_LT((back.covariance - movement.covariance).norm(), 1e-9);
}

TEST(Constraints, PlanarOnesMarginaliseHeightAndTilt) {
  const Movement movement{toPose3(Pose2{1, 2, 0.5}), someCovariance(1e-3)};
  mrpt::poses::CPosePDFGaussianInf constraint;
  toConstraint(movement, constraint);
  EXPECT_NEAR(constraint.mean.phi(), 0.5, 1e-12);
  const Eigen::Matrix3d covariance = constraint.cov_inv.asEigen().inverse();
  const int index[3] = {0, 1, 5};
  const Movement back = toMovement(constraint);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      EXPECT_NEAR(covariance(i, j), movement.covariance(index[i], index[j]), 1e-12);
      EXPECT_NEAR(back.covariance(index[i], index[j]), movement.covariance(index[i], index[j]), 1e-12);
    }
  }
  EXPECT_EQ(back.covariance(2, 2), 0.25);
  EXPECT_EQ(back.covariance(2, 0), 0);
}

TEST(Constraints, WhatNothingMeasuredHasACovariance) {
  mrpt::poses::CPosePDFGaussianInf constraint;
  constraint.cov_inv.setZero();
  constraint.cov_inv(0, 0) = 100;
  const Movement movement = toMovement(constraint);
  EXPECT_NEAR(movement.covariance(0, 0), 0.01, 1e-12);
  EXPECT_NEAR(movement.covariance(5, 5), 1e9, 1);
}

}  // namespace
}  // namespace roomgraph
