// SPDX-License-Identifier: BSD-3-Clause
// Median of a list of numbers.
#pragma once

#include <algorithm>
#include <vector>

namespace roomgraph {

/// The upper one of two in the middle; 0 when there are no values.
inline double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace roomgraph
