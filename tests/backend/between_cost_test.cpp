// SPDX-License-Identifier: BSD-3-Clause
// Derivatives of a movement's residual by hand, against automatic ones.
#include "between_cost.h"

#include <ceres/autodiff_cost_function.h>
#include <gtest/gtest.h>

#include <array>

#include "random_poses.h"

namespace roomgraph::test {
namespace {

struct Evaluated {
  Eigen::Matrix<double, 6, 1> residuals;
  Eigen::Matrix<double, 6, 3, Eigen::RowMajor> by_ta, by_tb;
  Eigen::Matrix<double, 6, 4, Eigen::RowMajor> by_qa, by_qb;
};

using Blocks = std::array<Eigen::Vector4d, 4>;  // of a translation the first three

Evaluated evaluate(const ceres::CostFunction& cost, const Blocks& at) {
  Evaluated out;
  const double* blocks[] = {at[0].data(), at[1].data(), at[2].data(), at[3].data()};
  double* jacobians[] = {out.by_ta.data(), out.by_qa.data(), out.by_tb.data(), out.by_qb.data()};
  EXPECT_TRUE(cost.Evaluate(blocks, out.residuals.data(), jacobians));
  return out;
}

TEST(BetweenCost, DerivativesAreTheAutomaticOnes) {
  int long_ways = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    Random random(seed);
    const auto number = [&](double scale) { return random.uniform(-scale, scale); };
    BetweenFactor factor;
    factor.a_from_b = poseFromYpr(number(2), number(2), number(2), number(3), number(1), number(3));
    for (int i = 0; i < 6; ++i) factor.covariance(i, i) = std::exp(number(3));
    factor.covariance(0, 4) = factor.covariance(4, 0) = 0.3 * std::sqrt(factor.covariance(0, 0) * factor.covariance(4, 4));
    Blocks at;
    for (auto& block : at) block = Eigen::Vector4d(number(1), number(1), number(1), number(1));
    for (const int q : {1, 3}) at[static_cast<std::size_t>(q)].normalize();
    const ceres::AutoDiffCostFunction<BetweenResidual, 6, 3, 4, 3, 4> automatic(new BetweenResidual(factor));
    const Evaluated a = evaluate(BetweenCost(factor), at), b = evaluate(automatic, at);
    EXPECT_LT((a.residuals - b.residuals).norm(), 1e-12 * b.residuals.norm());
    EXPECT_LT((a.by_ta - b.by_ta).norm(), 1e-12 * b.by_ta.norm());
    EXPECT_LT((a.by_tb - b.by_tb).norm(), 1e-12 * b.by_tb.norm());
    EXPECT_LT((a.by_qa - b.by_qa).norm(), 1e-12 * b.by_qa.norm());
    EXPECT_LT((a.by_qb - b.by_qb).norm(), 1e-12 * b.by_qb.norm());
    const Eigen::Quaterniond qa(at[1]), qb(at[3]);
    long_ways += (Eigen::Quaterniond(factor.a_from_b.linear()).conjugate() * (qa.conjugate() * qb)).w() < 0;
  }
  EXPECT_GT(long_ways, 20);
  EXPECT_LT(long_ways, 80);
}

// Ceres asks so for what is constant.
TEST(BetweenCost, DerivativesThatNobodyWantsAreLeftOut) {
  const BetweenCost cost{BetweenFactor{}};
  const Eigen::Vector4d t = Eigen::Vector4d::Zero(), q = Eigen::Vector4d::UnitW();
  const double* blocks[] = {t.data(), q.data(), t.data(), q.data()};
  Eigen::Matrix<double, 6, 1> residuals;
  EXPECT_TRUE(cost.Evaluate(blocks, residuals.data(), nullptr));
  Eigen::Matrix<double, 6, 3, Eigen::RowMajor> by_tb;
  double* jacobians[] = {nullptr, nullptr, by_tb.data(), nullptr};
  EXPECT_TRUE(cost.Evaluate(blocks, residuals.data(), jacobians));
  EXPECT_EQ(residuals.norm(), 0);
  EXPECT_TRUE((by_tb.topRows<3>().isApprox(Eigen::Matrix3d::Identity())));
}

}  // namespace
}  // namespace roomgraph::test
