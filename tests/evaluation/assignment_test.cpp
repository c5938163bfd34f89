// SPDX-License-Identifier: BSD-3-Clause
// Gated assignment against exhaustive search.
#include "assignment.h"

#include <gmock/gmock.h>

#include <set>

#include "random_poses.h"

namespace roomgraph {
namespace {

using test::Random;

struct Score {
  int pairs = 0;
  double cost = 0;
};

bool better(const Score& a, const Score& b) {
  return a.pairs != b.pairs ? a.pairs > b.pairs : a.cost < b.cost;
}

// Tries every choice for every row.
Score bruteForce(const Eigen::MatrixXd& costs, double gate, Eigen::Index row, unsigned used) {
  if (row == costs.rows()) return {};
  Score best = bruteForce(costs, gate, row + 1, used);
  for (Eigen::Index j = 0; j < costs.cols(); ++j) {
    if (costs(row, j) > gate || (used >> j & 1u)) continue;
    Score score = bruteForce(costs, gate, row + 1, used | 1u << j);
    ++score.pairs;
    score.cost += costs(row, j);
    if (better(score, best)) best = score;
  }
  return best;
}

TEST(Assignment, EqualsExhaustiveSearch) {
  Random random(7);
  for (int round = 0; round < 400; ++round) {
    Eigen::MatrixXd costs(random.index(7), random.index(7));
    for (Eigen::Index i = 0; i < costs.rows(); ++i)
      for (Eigen::Index j = 0; j < costs.cols(); ++j) costs(i, j) = random.uniform(0, 1);
    const double gate = random.uniform(0.1, 1.1);
    const auto columns = assignWithinGate(costs, gate);
    ASSERT_EQ(static_cast<Eigen::Index>(columns.size()), costs.rows());
    Score score;
    std::set<int> taken;
    for (Eigen::Index i = 0; i < costs.rows(); ++i) {
      const int j = columns[static_cast<std::size_t>(i)];
      if (j < 0) continue;
      ASSERT_TRUE(taken.insert(j).second) << "column given twice";
      ASSERT_LE(costs(i, j), gate);
      ++score.pairs;
      score.cost += costs(i, j);
    }
    const Score best = bruteForce(costs, gate, 0, 0);
    EXPECT_EQ(score.pairs, best.pairs);
    EXPECT_NEAR(score.cost, best.cost, 1e-9);
  }
}

TEST(Assignment, GreedyWouldFail) {
  // The nearest pair first (0.1) would leave row 0 alone.
  const Eigen::MatrixXd costs = (Eigen::MatrixXd(2, 2) << 0.2, 9, 0.1, 0.4).finished();
  EXPECT_THAT(assignWithinGate(costs, 0.5), ::testing::ElementsAre(0, 1));
}

TEST(Assignment, EmptyAndAllForbidden) {
  EXPECT_THAT(assignWithinGate(Eigen::MatrixXd(0, 3), 1), ::testing::IsEmpty());
  EXPECT_THAT(assignWithinGate(Eigen::MatrixXd(2, 0), 1), ::testing::ElementsAre(-1, -1));
  EXPECT_THAT(assignWithinGate(Eigen::MatrixXd::Constant(2, 2, 5), 1), ::testing::ElementsAre(-1, -1));
}

}  // namespace
}  // namespace roomgraph
