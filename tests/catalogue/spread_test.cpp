// SPDX-License-Identifier: BSD-3-Clause
// Quantiles and the interval of a median, against values worked out elsewhere and coverage by simulation.
#include "roomgraph/catalogue/spread.h"

#include <gtest/gtest.h>

#include <random>

namespace roomgraph::test {
namespace {

// quantile(c(1, 2, 4, 8), type = 7) of R.
TEST(Spread, IsThatOfType7) {
  const Spread s = spreadOf({8, 1, 4, 2});
  EXPECT_EQ(s.count, 4u);
  EXPECT_DOUBLE_EQ(s.least, 1);
  EXPECT_DOUBLE_EQ(s.first_quartile, 1.75);
  EXPECT_DOUBLE_EQ(s.median, 3);
  EXPECT_DOUBLE_EQ(s.third_quartile, 5);
  EXPECT_DOUBLE_EQ(s.largest, 8);
  EXPECT_EQ(spreadOf({}).count, 0u);
  EXPECT_DOUBLE_EQ(spreadOf({7}).median, 7);
}

// Table A3 of Conover's book for p = 1/2: with n = 20 the 6th and the 15th value, with n = 10 the 2nd and the
// 9th; with 5 no pair reaches 95 %.
TEST(MedianInterval, TakesTheTabledOrderStatistics) {
  const auto ordered = [](int n) {
    std::vector<double> values;
    for (int i = n; i > 0; --i) values.push_back(i);
    return values;
  };
  EXPECT_EQ(medianInterval(ordered(20)), std::pair(6.0, 15.0));
  EXPECT_EQ(medianInterval(ordered(10)), std::pair(2.0, 9.0));
  EXPECT_EQ(medianInterval(ordered(6)), std::pair(1.0, 6.0));
  EXPECT_EQ(medianInterval(ordered(5)), std::pair(1.0, 5.0));
  EXPECT_EQ(medianInterval({3}), std::pair(3.0, 3.0));
}

TEST(MedianInterval, HoldsTheMedianAsOftenAsItSays) {
  std::mt19937 random(5);
  std::exponential_distribution<double> skewed;
  int held = 0;
  constexpr int kTrials = 4000;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> values;
    for (int i = 0; i < 25; ++i) values.push_back(skewed(random));
    const auto [low, high] = medianInterval(values);
    held += low <= std::log(2.0) && std::log(2.0) <= high;
  }
  EXPECT_NEAR(held / double{kTrials}, 0.957, 0.012);  // the binomial law: 1 - 2 P(B(25, 1/2) < 8)
}

}  // namespace
}  // namespace roomgraph::test
