// SPDX-License-Identifier: BSD-3-Clause
// Wilcoxon's test against published values and against counting all signs.
#include "roomgraph/catalogue/signed_rank.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace roomgraph::test {
namespace {

// Two-sided p-value by going through all 2^n signs, ranks by comparing each with all.
double byCounting(const std::vector<double>& differences) {
  std::vector<double> sizes;
  double observed = 0;
  for (const double d : differences)
    if (d != 0) sizes.push_back(std::abs(d));
  const std::size_t n = sizes.size();
  std::vector<double> ranks(n);
  for (std::size_t i = 0; i < n; ++i)
    for (const double other : sizes) ranks[i] += other < sizes[i] ? 1 : other == sizes[i] ? 0.5 : 0;
  for (auto& rank : ranks) rank += 0.5;
  std::size_t place = 0;
  for (const double d : differences) {
    if (d > 0) observed += ranks[place];
    if (d != 0) ++place;
  }
  const double mean = static_cast<double>(n * (n + 1)) / 4;
  std::size_t extreme = 0;
  for (std::size_t signs = 0; signs < std::size_t{1} << n; ++signs) {
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i)
      if (signs >> i & 1) sum += ranks[i];
    extreme += std::abs(sum - mean) >= std::abs(observed - mean) - 1e-9;
  }
  return static_cast<double>(extreme) / std::pow(2.0, static_cast<double>(n));
}

// Hamilton depression scale before and after a tranquilizer: Hollander and Wolfe (1973), p. 29; V = 40,
// one-sided p = 0.0195.
TEST(SignedRank, GivesThePublishedValue) {
  const double before[] = {1.83, 0.50, 1.62, 2.48, 1.68, 1.88, 1.55, 3.06, 1.30};
  const double after[] = {0.878, 0.647, 0.598, 2.05, 1.06, 1.29, 1.06, 3.14, 1.29};
  std::vector<double> differences;
  for (int i = 0; i < 9; ++i) differences.push_back(before[i] - after[i]);
  const auto test = signedRankTest(differences);
  EXPECT_EQ(test.used, 9u);
  EXPECT_DOUBLE_EQ(test.statistic, 40);
  EXPECT_NEAR(test.p_value, 2 * 0.01953125, 1e-12);
}

TEST(SignedRank, CountsAsAllSignsDo) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> few(-4, 5);  // many ties and zeros
  std::normal_distribution<double> any(0.4, 1);
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<double> differences;
    const int n = 1 + trial % 12;
    for (int i = 0; i < n; ++i) differences.push_back(trial % 2 ? few(random) : any(random));
    const auto test = signedRankTest(differences);
    if (test.used == 0) continue;
    EXPECT_NEAR(test.p_value, byCounting(differences), 1e-12) << "trial " << trial;
  }
}

// Where counting ends, the normal law says nearly the same.
TEST(SignedRank, BothLawsAgreeWhereTheyMeet) {
  std::mt19937 random(8);
  std::normal_distribution<double> any(0.3, 1);
  for (const std::size_t n : {60u, 61u}) {
    std::vector<double> differences;
    while (differences.size() < n) differences.push_back(any(random));
    const auto test = signedRankTest(differences);
    const double count = static_cast<double>(n), variance = count * (count + 1) * (2 * count + 1) / 24;
    const double z = (std::abs(test.statistic - count * (count + 1) / 4) - 0.5) / std::sqrt(variance);
    EXPECT_NEAR(test.p_value, std::erfc(z / std::sqrt(2.0)), n == 60 ? 0.002 : 1e-12) << n;
  }
}

TEST(SignedRank, RejectsAsOftenAsItSays) {
  std::mt19937 random(4);
  std::normal_distribution<double> none(0, 1);
  for (const int n : {20, 200}) {
    int rejected = 0;
    constexpr int kTrials = 2000;
    for (int trial = 0; trial < kTrials; ++trial) {
      std::vector<double> differences;
      for (int i = 0; i < n; ++i) differences.push_back(none(random));
      rejected += signedRankTest(differences).p_value < 0.05;
    }
    EXPECT_NEAR(rejected / double{kTrials}, 0.05, 0.015) << n;
  }
}

TEST(SignedRank, WithoutDifferencesSaysNothing) {
  EXPECT_EQ(signedRankTest({}).p_value, 1);
  EXPECT_EQ(signedRankTest({0, 0, 0}).p_value, 1);
  EXPECT_EQ(signedRankTest({0, 0, 0}).used, 0u);
}

// The example of Holm's procedure with m = 4: 0.005, 0.01, 0.03, 0.04 -> 0.02, 0.03, 0.06, 0.06.
TEST(Holm, StepsDownInOrder) {
  const auto adjusted = holmAdjusted({0.01, 0.04, 0.03, 0.005});
  const double expected[] = {0.03, 0.06, 0.06, 0.02};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(adjusted[i], expected[i], 1e-12);
  EXPECT_EQ(holmAdjusted({0.9, 0.8})[0], 1);
}

}  // namespace
}  // namespace roomgraph::test
