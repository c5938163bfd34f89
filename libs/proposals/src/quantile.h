// SPDX-License-Identifier: BSD-3-Clause
// Quantile of a list of numbers.
#pragma once

#include <vector>

namespace roomgraph {

/// Quantile (ratio in [0, 1]) of the values, the nearest of them; 0 for none.
double quantile(std::vector<double> values, double ratio);

}  // namespace roomgraph
