// SPDX-License-Identifier: BSD-3-Clause
// Exclusive assignment against enumeration of all joint assignments.
#include "exclusive_assignment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "random_poses.h"

namespace roomgraph::test {
namespace {

struct Enumerated {
  Eigen::MatrixXd marginal;
  Eigen::VectorXd none;
  double total = 0, best = -1;
  std::vector<int> best_choice;
};

// Visits every joint assignment that gives no landmark twice.
void enumerate(const Eigen::MatrixXd& ratios, std::vector<int>& choice, double weight, Enumerated& out) {
  if (static_cast<Eigen::Index>(choice.size()) == ratios.rows()) {
    out.total += weight;
    if (weight > out.best) out.best = weight, out.best_choice = choice;
    for (std::size_t k = 0; k < choice.size(); ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      (choice[k] < 0 ? out.none[row] : out.marginal(row, choice[k])) += weight;
    }
    return;
  }
  const auto k = static_cast<Eigen::Index>(choice.size());
  for (int j = -1; j < static_cast<int>(ratios.cols()); ++j) {
    if (j >= 0 && (ratios(k, j) <= 0 || std::count(choice.begin(), choice.end(), j) > 0)) continue;
    choice.push_back(j);
    enumerate(ratios, choice, j < 0 ? weight : weight * ratios(k, j), out);
    choice.pop_back();
  }
}

Enumerated bruteForce(const Eigen::MatrixXd& ratios) {
  Enumerated out;
  out.marginal = Eigen::MatrixXd::Zero(ratios.rows(), ratios.cols());
  out.none = Eigen::VectorXd::Zero(ratios.rows());
  std::vector<int> choice;
  enumerate(ratios, choice, 1, out);
  out.marginal /= out.total;
  out.none /= out.total;
  return out;
}

Eigen::MatrixXd randomRatios(Random& random, int rows, int columns, double share) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rows, columns);
  for (int k = 0; k < rows; ++k)
    for (int j = 0; j < columns; ++j)
      if (random.uniform(0, 1) < share) out(k, j) = std::exp(random.uniform(-6, 6));
  return out;
}

TEST(ExclusiveAssignment, AgreesWithEnumeration) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    Random random(seed);
    const auto ratios =
        randomRatios(random, 1 + random.index(5), 1 + random.index(6), random.uniform(0.2, 1));
    const auto expected = bruteForce(ratios);
    const auto joint = solveExclusive(ratios);
    EXPECT_LT((joint.marginal - expected.marginal).cwiseAbs().maxCoeff(), 1e-12) << "seed " << seed;
    EXPECT_LT((joint.none - expected.none).cwiseAbs().maxCoeff(), 1e-12) << "seed " << seed;
    EXPECT_EQ(joint.best, expected.best_choice) << "seed " << seed;
  }
}

TEST(ExclusiveAssignment, RowsSumToOneAndNoLandmarkServesTwiceHoweverManyThereAre) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Random random(seed);
    const auto joint = solveExclusive(randomRatios(random, 15, 14, 0.6));  // more than is summed exactly
    std::vector<char> taken(14, 0);
    for (Eigen::Index k = 0; k < 15; ++k) {
      EXPECT_NEAR(joint.marginal.row(k).sum() + joint.none[k], 1, 1e-9);
      const int j = joint.best[static_cast<std::size_t>(k)];
      if (j < 0) continue;
      EXPECT_FALSE(taken[static_cast<std::size_t>(j)]);
      taken[static_cast<std::size_t>(j)] = 1;
    }
    EXPECT_LE(joint.marginal.colwise().sum().maxCoeff(), 1 + 1e-9);
  }
}

TEST(ExclusiveAssignment, ExtremeRatiosStayFinite) {
  Eigen::MatrixXd ratios = Eigen::MatrixXd::Constant(6, 6, 1e300);
  ratios(0, 0) = 1e-300;
  const auto joint = solveExclusive(ratios);
  EXPECT_TRUE(joint.marginal.allFinite());
  EXPECT_EQ(std::count(joint.best.begin(), joint.best.end(), -1), 0);
}

// Two groups of seven, one weak link between them: fourteen are too many at once, and the weak link goes.
TEST(ExclusiveAssignment, TooLargeAProblemFallsApartAtItsWeakestLink) {
  Random random(6);
  const Eigen::MatrixXd first = randomRatios(random, 7, 7, 1), second = randomRatios(random, 7, 7, 1);
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(14, 14);
  all.topLeftCorner(7, 7) = first;
  all.bottomRightCorner(7, 7) = second;
  all(3, 10) = 1e-6;
  const JointAssignment joint = solveExclusive(all), one = solveExclusive(first), two = solveExclusive(second);
  EXPECT_LT((joint.marginal.topLeftCorner(7, 7) - one.marginal).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((joint.marginal.bottomRightCorner(7, 7) - two.marginal).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_EQ(joint.marginal(3, 10), 0);
}

TEST(ExclusiveAssignment, NothingToAssign) {
  EXPECT_TRUE(solveExclusive(Eigen::MatrixXd(0, 0)).best.empty());
  const auto joint = solveExclusive(Eigen::MatrixXd(2, 0));
  EXPECT_EQ(joint.best, (std::vector<int>{-1, -1}));
  EXPECT_DOUBLE_EQ(joint.none[1], 1);
}

}  // namespace
}  // namespace roomgraph::test
