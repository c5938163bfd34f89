// SPDX-License-Identifier: BSD-3-Clause
// Quantiles of sorted values; the binomial law for the median's interval.
#include "roomgraph/catalogue/spread.h"

#include <algorithm>
#include <cmath>

namespace roomgraph {
namespace {

double linearQuantile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto low = static_cast<std::size_t>(place);
  const std::size_t high = std::min(low + 1, sorted.size() - 1);
  return sorted[low] + (place - static_cast<double>(low)) * (sorted[high] - sorted[low]);
}

// How many values to leave out at either end: the largest r with P(Binomial(n, 1/2) < r) <= (1 - confidence)
// / 2.
std::size_t leftOut(std::size_t n, double confidence) {
  const double tail = (1 - confidence) / 2, count = static_cast<double>(n);
  double below = 0;
  std::size_t r = 0;
  for (; r < n / 2; ++r) {
    const double k = static_cast<double>(r);
    below += std::exp(std::lgamma(count + 1) - std::lgamma(k + 1) - std::lgamma(count - k + 1) -
                      count * std::log(2.0));
    if (below > tail) break;
  }
  return r;
}

}  // namespace

Spread spreadOf(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  return {values.size(),
          values.front(),
          linearQuantile(values, 0.25),
          linearQuantile(values, 0.5),
          linearQuantile(values, 0.75),
          values.back()};
}

std::pair<double, double> medianInterval(std::vector<double> values, double confidence) {
  std::sort(values.begin(), values.end());
  const std::size_t r = leftOut(values.size(), confidence);
  const std::size_t low = r > 0 ? r - 1 : 0;
  return {values[low], values[values.size() - 1 - low]};
}

}  // namespace roomgraph
