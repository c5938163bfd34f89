// SPDX-License-Identifier: BSD-3-Clause
// Summary statistics of a set of errors: RMSE, mean, median, 95th percentile, maximum.
#pragma once

#include <vector>

namespace roomgraph {

/// Summary of a set of errors; all 0 when count is 0.
struct ErrorStatistics {
  int count = 0;
  double rmse = 0, mean = 0, median = 0, max = 0;
  double p95 = 0;           ///< smallest error that 95 % of all do not exceed
  double std = 0;           ///< of the population (divided by count)
  double squared_mean = 0;  ///< mean of the squares, as Kümmerle et al. report
  double squared_std = 0;   ///< standard deviation of the squares
};

ErrorStatistics summarize(std::vector<double> errors);

}  // namespace roomgraph
