// SPDX-License-Identifier: BSD-3-Clause
// LogHistogram: quantiles against those of all values sorted.
#include "log_histogram.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "roomgraph/core/order_statistics.h"

namespace roomgraph {
namespace {

TEST(LogHistogram, HasTheQuantilesOfTheValues) {
  std::mt19937 random(4);
  std::lognormal_distribution<double> drawn(0.7, 0.8);
  for (const double unit : {1e-3, 1.0, 1e3}) {  // of a depth image
    LogHistogram histogram;
    std::vector<double> values;
    for (int i = 0; i < 5000; ++i) {
      values.push_back(unit * drawn(random));
      histogram.add(values.back());
    }
    EXPECT_EQ(histogram.size(), 5000u);
    for (const double ratio : {0.0, 0.05, 0.5, 0.95, 1.0}) {
      const double exact = quantile(values, ratio);
      EXPECT_NEAR(histogram.quantile(ratio), exact, 0.00051 * exact) << ratio << " of values of " << unit;
    }
  }
}

TEST(LogHistogram, OneValueIsAllQuantilesAndNoneIsZero) {
  LogHistogram histogram;
  EXPECT_EQ(histogram.quantile(0.5), 0);
  histogram.add(2.5);
  for (const double ratio : {0.0, 0.5, 1.0}) EXPECT_NEAR(histogram.quantile(ratio), 2.5, 0.0013);
}

TEST(LogHistogram, WhatIsBeyondTheEndsCountsForThem) {
  LogHistogram histogram;
  histogram.add(std::numeric_limits<double>::infinity());
  for (const double low : {1e-9, 0.0, -2.0, std::numeric_limits<double>::quiet_NaN()}) histogram.add(low);
  EXPECT_EQ(histogram.size(), 5u);
  EXPECT_NEAR(histogram.quantile(0), 1e-6, 1e-8);
  EXPECT_NEAR(histogram.quantile(0.75), 1e-6, 1e-8);
  EXPECT_NEAR(histogram.quantile(1), 1e6, 1e4);
}

}  // namespace
}  // namespace roomgraph
