// SPDX-License-Identifier: BSD-3-Clause
// Median, quartiles and range of a sample; interval of a median.
#pragma once

#include <utility>
#include <vector>

namespace roomgraph {

/// Of a sample.
struct Spread {
  std::size_t count = 0;
  double least = 0, first_quartile = 0, median = 0, third_quartile = 0, largest = 0;
};

/// Quantiles linear between the two nearest of the sorted values (Hyndman and Fan 1996, type 7); all 0 for no
/// values.
Spread spreadOf(std::vector<double> values);

/// Interval that holds the median of whatever the values are drawn from with at least `confidence`, whatever
/// the distribution: the pair of order statistics between which the binomial law puts it (Conover, Practical
/// Nonparametric Statistics, 3.2). With fewer values than that takes (6 for 95 %), from the least to the
/// largest. Needs at least one value.
std::pair<double, double> medianInterval(std::vector<double> values, double confidence = 0.95);

}  // namespace roomgraph
