// SPDX-License-Identifier: BSD-3-Clause
// Second differences of neighbouring ranges.
#include "roomgraph/observations/roughness.h"

#include <algorithm>
#include <cmath>

#include "roomgraph/core/order_statistics.h"

namespace roomgraph {

double roughnessOf(const std::vector<float>& ranges_m, double share, std::size_t least) {
  std::vector<double> bends;
  for (std::size_t i = 1; i + 1 < ranges_m.size(); ++i) {
    const float a = ranges_m[i - 1], b = ranges_m[i], c = ranges_m[i + 1];
    if (a > 0 && b > 0 && c > 0) bends.push_back(std::abs(static_cast<double>(a) - 2.0 * b + c));
  }
  return bends.size() < least ? 0 : quantile(std::move(bends), share);
}

double roughnessOfScan(const std::vector<float>& ranges_m) {
  constexpr double kShare = 0.2, kMedianOfNormal = 0.6745, kShareOfNormal = 0.2533;
  constexpr std::size_t kLeast = 40;
  return roughnessOf(ranges_m, kShare, kLeast) * (kMedianOfNormal / kShareOfNormal);
}

double roughnessLimit(double usual_m) {
  constexpr double kTimes = 4, kLeast_m = 0.08;
  return std::max(kTimes * usual_m, kLeast_m);
}

}  // namespace roomgraph
