// SPDX-License-Identifier: BSD-3-Clause
// Wilcoxon's signed-rank test and Holm's correction of many p-values.
#pragma once

#include <cstddef>
#include <vector>

namespace roomgraph {

/// Outcome of the test whether differences are symmetric about 0.
struct SignedRankTest {
  std::size_t used = 0;  ///< differences other than 0
  double statistic = 0;  ///< sum of the ranks of positive differences
  double p_value = 1;    ///< two-sided
};

/// Wilcoxon's signed-rank test (Wilcoxon 1945): differences of 0 are left out, ties share their mean rank. Up
/// to 60 differences the law of the statistic is counted exactly, ties included; beyond, it is taken as
/// normal, with the variance corrected for ties and half a step for continuity (Lehmann, Nonparametrics,
/// 1975).
SignedRankTest signedRankTest(const std::vector<double>& differences);

/// p-values for which the chance of even one false finding among all is kept (Holm 1979), in the same order.
std::vector<double> holmAdjusted(const std::vector<double>& p_values);

}  // namespace roomgraph
