// SPDX-License-Identifier: BSD-3-Clause
// Every residual at its measurement, against values by hand and numerical derivatives.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "residual_specimens.h"

namespace roomgraph::test {
namespace {

constexpr unsigned kResidualSeeds = 8;

std::vector<const double*> pointers(const std::vector<Block>& blocks) {
  std::vector<const double*> out;
  for (const auto& block : blocks) out.push_back(block.value.data());
  return out;
}

Eigen::VectorXd residualsOf(const Specimen& specimen) {
  Eigen::VectorXd out(specimen.cost->num_residuals());
  EXPECT_TRUE(specimen.cost->Evaluate(pointers(specimen.blocks).data(), out.data(), nullptr));
  return out;
}

void move(Block& block, const Eigen::VectorXd& delta) {
  const std::vector<double> from = block.value;
  if (block.quaternion) {
    ceres::EigenQuaternionManifold().Plus(from.data(), delta.data(), block.value.data());
  } else {
    for (std::size_t i = 0; i < from.size(); ++i) block.value[i] += delta[static_cast<Eigen::Index>(i)];
  }
}

Eigen::Index freedoms(const Block& block) {
  return block.quaternion ? 3 : static_cast<Eigen::Index>(block.value.size());
}

// Derivative along the tangent of one block, from automatic differentiation.
Eigen::MatrixXd automatic(const Specimen& specimen, std::size_t which) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const int rows = specimen.cost->num_residuals();
  const Block& block = specimen.blocks[which];
  std::vector<double> ambient(static_cast<std::size_t>(rows) * block.value.size()),
      values(ambient.size() + 8);
  std::vector<double*> jacobians(specimen.blocks.size(), nullptr);
  jacobians[which] = ambient.data();
  specimen.cost->Evaluate(pointers(specimen.blocks).data(), values.data(), jacobians.data());
  Eigen::Map<RowMajor> jacobian(ambient.data(), rows, static_cast<Eigen::Index>(block.value.size()));
  if (!block.quaternion) return jacobian;
  Eigen::Matrix<double, 4, 3, Eigen::RowMajor> plus;
  ceres::EigenQuaternionManifold().PlusJacobian(block.value.data(), plus.data());
  return jacobian * plus;
}

Eigen::MatrixXd central(const Specimen& specimen, std::size_t which) {
  constexpr double kStep = 1e-6;
  Eigen::MatrixXd out(specimen.cost->num_residuals(), freedoms(specimen.blocks[which]));
  for (Eigen::Index j = 0; j < out.cols(); ++j) {
    Specimen ahead = specimen, behind = specimen;
    const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(out.cols(), j);
    move(ahead.blocks[which], step);
    move(behind.blocks[which], -step);
    out.col(j) = (residualsOf(ahead) - residualsOf(behind)) / (2 * kStep);
  }
  return out;
}

class ResidualTest : public ::testing::TestWithParam<ResidualCase> {};

TEST_P(ResidualTest, VanishesAtTheMeasurement) {
  for (unsigned seed = 1; seed <= kResidualSeeds; ++seed) {
    Random random(seed);
    EXPECT_LT(residualsOf(GetParam().at_measurement(random)).norm(), 1e-9) << "seed " << seed;
  }
}

TEST_P(ResidualTest, HasTheValueWorkedOutByHand) {
  const Specimen specimen = GetParam().by_hand();
  const Eigen::VectorXd residuals = residualsOf(specimen);
  ASSERT_EQ(residuals.size(), static_cast<Eigen::Index>(specimen.residuals.size()));
  const Eigen::VectorXd expected =
      Eigen::Map<const Eigen::VectorXd>(specimen.residuals.data(), residuals.size());
  EXPECT_GT(expected.norm(), 0.1) << "an error that is zero proves nothing";
  EXPECT_LT((residuals - expected).norm(), 1e-9) << residuals.transpose() << "\nnot\n"
                                                 << expected.transpose();
}

TEST_P(ResidualTest, DerivativesAgreeWithCentralDifferences) {
  for (unsigned seed = 1; seed <= kResidualSeeds; ++seed) {
    Random random(seed);
    Specimen specimen = GetParam().at_measurement(random);
    for (auto& block : specimen.blocks) {
      Eigen::VectorXd delta(freedoms(block));
      for (auto& d : delta) d = random.uniform(-0.2, 0.2);
      move(block, delta);
    }
    for (std::size_t i = 0; i < specimen.blocks.size(); ++i) {
      const Eigen::MatrixXd a = automatic(specimen, i), b = central(specimen, i);
      EXPECT_LT((a - b).norm(), 1e-6 * (1 + b.norm())) << "seed " << seed << " block " << i << "\n"
                                                       << a << "\n\n"
                                                       << b;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, ResidualTest, ::testing::ValuesIn(residualCases()),
                         [](const auto& entry) { return entry.param.name; });

TEST(Residuals, LandmarkWithoutYawLeavesYawFree) {
  LandmarkFactor factor;
  factor.covariance << 0.04, 0, 0, 0.03, 0, 0.04, 0, 0, 0, 0, 0.04, 0, 0.03, 0, 0, 0.09;
  factor.position_in_robot = {1, 0, 0};
  Specimen specimen{sharedCost(factor), blocksOf(Pose3::Identity())};
  specimen.blocks.push_back({{1.2, 0, 0, 2.5}});
  const Eigen::VectorXd residuals = residualsOf(specimen);
  EXPECT_NEAR(residuals[0], 1, 1e-9);  // 0.2 m over a sigma of 0.2 m, whatever the yaw says
  EXPECT_EQ(residuals[3], 0);
}

TEST(Residuals, RotationTakesTheShortWayRound) {
  BetweenFactor factor;
  factor.a_from_b = poseFromYpr(0, 0, 0, 3.1, 0, 0);
  Specimen specimen{sharedCost(factor), blocksOf(Pose3::Identity())};
  append(specimen.blocks, poseFromYpr(0, 0, 0, -3.1, 0, 0));
  EXPECT_NEAR(residualsOf(specimen)[5], 2 * std::sin((2 * M_PI - 6.2) / 2), 1e-9);
}

}  // namespace
}  // namespace roomgraph::test
