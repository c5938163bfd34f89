// SPDX-License-Identifier: BSD-3-Clause
// Chain CRF against enumeration of all choices.
#include "crf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "random_poses.h"

namespace roomgraph::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Energy of one choice of states, written out term by term.
double energyOf(const ChainProblem& problem, const std::vector<int>& states) {
  double sum = 0;
  bool appears = false;
  for (std::size_t f = 0; f < states.size(); ++f) {
    sum += problem.unary[f][static_cast<std::size_t>(states[f])];
    appears = appears || states[f] > 0;
    if (f > 0) sum += problem.pairwise[f - 1](states[f - 1], states[f]);
  }
  return problem.must_appear && !appears ? kInfinity : sum;
}

void forEachChoice(const ChainProblem& problem, const std::function<void(const std::vector<int>&)>& visit) {
  std::vector<int> states(problem.unary.size(), 0);
  while (true) {
    visit(states);
    std::size_t f = 0;
    while (f < states.size() && ++states[f] == static_cast<int>(problem.unary[f].size())) states[f++] = 0;
    if (f == states.size()) return;
  }
}

struct Enumerated {
  double energy = kInfinity;
  std::vector<std::vector<double>> marginals;  // empty: nothing allowed
};

Enumerated enumerate(const ChainProblem& problem, double temperature) {
  Enumerated out;
  double partition = 0;
  for (const auto& unary : problem.unary) out.marginals.emplace_back(unary.size(), 0.0);
  forEachChoice(problem, [&](const std::vector<int>& states) {
    const double energy = energyOf(problem, states);
    const double weight = std::exp(-energy / temperature);
    out.energy = std::min(out.energy, energy);
    partition += weight;
    for (std::size_t f = 0; f < states.size(); ++f)
      out.marginals[f][static_cast<std::size_t>(states[f])] += weight;
  });
  for (auto& frame : out.marginals)
    for (double& value : frame) value /= partition;
  if (partition == 0) out.marginals.clear();
  return out;
}

// `grid`: energies are multiples of it, so that ties are frequent; 0: any number.
ChainProblem randomChain(Random& random, double grid, double forbidden_share) {
  const auto energy = [&](double low, double high) {
    if (random.uniform(0, 1) < forbidden_share) return kInfinity;
    const double value = random.uniform(low, high);
    return grid > 0 ? grid * std::round(value / grid) : value;
  };
  ChainProblem problem;
  problem.must_appear = random.index(2) == 1;
  const int frames = 1 + random.index(5);
  for (int f = 0; f < frames; ++f) {
    problem.unary.emplace_back(1, 0.0);
    for (int i = random.index(4); i > 0; --i) problem.unary.back().push_back(energy(-1, 0.5));
    if (f == 0) continue;
    auto& table = problem.pairwise.emplace_back(problem.unary[problem.unary.size() - 2].size(),
                                                problem.unary.back().size());
    for (Eigen::Index x = 0; x < table.rows(); ++x)
      for (Eigen::Index y = 0; y < table.cols(); ++y) table(x, y) = energy(0, 1);
  }
  return problem;
}

void expectAsEnumerated(const ChainProblem& problem, double temperature) {
  const Enumerated truth = enumerate(problem, temperature);
  const ChainSolution solution = minimize(problem);
  const auto found = marginals(problem, temperature);
  if (truth.energy == kInfinity) {
    EXPECT_EQ(solution.energy, kInfinity);
    EXPECT_TRUE(solution.states.empty());
    EXPECT_TRUE(found.empty());
    return;
  }
  ASSERT_EQ(solution.states.size(), problem.unary.size());
  EXPECT_NEAR(solution.energy, truth.energy, 1e-12);
  EXPECT_NEAR(energyOf(problem, solution.states), truth.energy, 1e-12);
  ASSERT_EQ(found.size(), problem.unary.size());
  for (std::size_t f = 0; f < found.size(); ++f) {
    ASSERT_EQ(found[f].size(), problem.unary[f].size());
    for (std::size_t x = 0; x < found[f].size(); ++x) EXPECT_NEAR(found[f][x], truth.marginals[f][x], 1e-10);
  }
}

TEST(Crf, AgreesWithEnumeration) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    Random random(seed);
    for (int round = 0; round < 400; ++round)
      expectAsEnumerated(randomChain(random, 0, 0), random.uniform(0.05, 2));
  }
}

TEST(Crf, AgreesWithEnumerationWhenManyChoicesTie) {
  Random random(11);
  for (int round = 0; round < 500; ++round)
    expectAsEnumerated(randomChain(random, 0.5, 0), random.uniform(0.05, 2));
}

TEST(Crf, AgreesWithEnumerationWhenStatesAreForbidden) {
  Random random(12);
  int infeasible = 0;
  for (int round = 0; round < 500; ++round) {
    const ChainProblem problem = randomChain(random, 0, 0.3);
    infeasible += minimize(problem).states.empty();
    expectAsEnumerated(problem, random.uniform(0.05, 2));
  }
  EXPECT_GT(infeasible, 20);
}

TEST(Crf, FramesWithoutProposals) {
  ChainProblem problem;
  problem.unary = {{0}, {0}, {0}};
  problem.pairwise = {Eigen::MatrixXd::Zero(1, 1), Eigen::MatrixXd::Zero(1, 1)};
  EXPECT_EQ(minimize(problem).states, (std::vector<int>{0, 0, 0}));
  EXPECT_EQ(marginals(problem, 1).back(), std::vector<double>{1});
  problem.must_appear = true;
  EXPECT_EQ(minimize(problem).energy, kInfinity);
  EXPECT_TRUE(marginals(problem, 1).empty());
  EXPECT_TRUE(minimize({}).states.empty());
  EXPECT_TRUE(marginals({}, 1).empty());
}

// With energies that the selector makes: proposals lower the energy, to vanish costs .9, and the newest frame may
// not take its own.
TEST(Crf, AnObjectMustAppearOnce) {
  ChainProblem problem;
  problem.unary = {{0, -0.3}, {0, -0.5, -0.2}, {0, kInfinity}};
  problem.pairwise = {Eigen::MatrixXd(2, 3), Eigen::MatrixXd(3, 2)};
  problem.pairwise[0] << 0, 0, 0, 0.9, 0.8, 0.9;
  problem.pairwise[1] << 0, 0, 0.9, 0.7, 0.9, 0.9;
  EXPECT_EQ(minimize(problem).states, (std::vector<int>{0, 0, 0}));
  EXPECT_EQ(minimize(problem).energy, 0);
  problem.must_appear = true;
  EXPECT_EQ(minimize(problem).states, (std::vector<int>{0, 1, 0})) << "once is enough, where it costs least";
  EXPECT_DOUBLE_EQ(minimize(problem).energy, -0.5 + 0.9);
}

TEST(Crf, TiesGoToTheHigherState) {
  ChainProblem problem;
  problem.unary = {{0, -1, -1, 0}, {0, 0}};
  problem.pairwise = {Eigen::MatrixXd::Zero(4, 2)};
  EXPECT_EQ(minimize(problem).states, (std::vector<int>{2, 1}));
}

// At a low temperature weights reach exp(1000): only sums of logarithms survive.
TEST(Crf, MarginalsAreStableWhenCold) {
  ChainProblem problem;
  problem.unary = {{0, -1, -0.9}, {0, -1, -1}};
  problem.pairwise = {Eigen::MatrixXd::Zero(3, 3)};
  const auto found = marginals(problem, 0.001);
  EXPECT_NEAR(found[0][1], 1, 1e-12);
  EXPECT_NEAR(found[1][1], 0.5, 1e-12);
  EXPECT_NEAR(found[1][2], 0.5, 1e-12);
}

}  // namespace
}  // namespace roomgraph::test
