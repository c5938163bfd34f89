// SPDX-License-Identifier: BSD-3-Clause
// Quantile and median of a list of numbers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace roomgraph {

/// Quantile of `ratio` in [0, 1] by nearest rank; 0 for no values.
inline double quantile(std::vector<double> values, double ratio) {
  if (values.empty()) return 0;
  const auto index = static_cast<std::ptrdiff_t>(ratio * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + index, values.end());
  return values[static_cast<std::size_t>(index)];
}

/// Median: of an even number of values the upper one of the middle two; 0 for no values.
inline double median(std::vector<double> values) {
  return quantile(std::move(values), 0.5);
}

}  // namespace roomgraph
