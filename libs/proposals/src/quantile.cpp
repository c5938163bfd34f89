// SPDX-License-Identifier: BSD-3-Clause
// Quantile by partial sorting.
#include "quantile.h"

#include <algorithm>

namespace roomgraph {

double quantile(std::vector<double> values, double ratio) {
  if (values.empty()) return 0;
  const auto index = static_cast<std::ptrdiff_t>(ratio * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + index, values.end());
  return values[index];
}

}  // namespace roomgraph
