// SPDX-License-Identifier: BSD-3-Clause
// Moments and order statistics of errors.
#include "roomgraph/evaluation/statistics.h"

#include <algorithm>
#include <cmath>

namespace roomgraph {

ErrorStatistics summarize(std::vector<double> errors) {
  ErrorStatistics out;
  out.count = static_cast<int>(errors.size());
  if (errors.empty()) return out;
  std::sort(errors.begin(), errors.end());
  const double n = static_cast<double>(errors.size());
  for (const double e : errors) {
    out.mean += e / n;
    out.squared_mean += e * e / n;
  }
  double variance = 0, squared_variance = 0;
  for (const double e : errors) {
    variance += (e - out.mean) * (e - out.mean) / n;
    squared_variance += (e * e - out.squared_mean) * (e * e - out.squared_mean) / n;
  }
  out.rmse = std::sqrt(out.squared_mean);
  out.std = std::sqrt(variance);
  out.squared_std = std::sqrt(squared_variance);
  const std::size_t half = errors.size() / 2;
  out.median = errors.size() % 2 == 1 ? errors[half] : (errors[half - 1] + errors[half]) / 2;
  out.p95 = errors[(errors.size() * 95 + 99) / 100 - 1];
  out.max = errors.back();
  return out;
}

}  // namespace roomgraph
