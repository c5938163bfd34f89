// SPDX-License-Identifier: BSD-3-Clause
// Number and weight of measurements whose errors repeat.
#pragma once

#include <cstddef>
#include <vector>

namespace roomgraph {

/// Weight of one of `count` measurements whose errors have this share of their variance in common. Together they are
/// worth as much as their mean, whose variance is (share + (1 - share) / count) times that of one.
inline double weightAmong(std::size_t count, double repeating_share) {
  return 1 / (1 + repeating_share * (static_cast<double>(count) - 1));
}

/// So many of one landmark from one direction are used: more say nothing new, and a graph would grow with time in place of
/// with what was seen.
constexpr std::size_t kMostOfDirection = 12;

/// `most` of all, evenly in their order, that of the beams or of time.
template <class T>
std::vector<T> thinned(const std::vector<T>& all, std::size_t most) {
  if (all.size() <= most) return all;
  std::vector<T> out;
  for (std::size_t i = 0; i < most; ++i) out.push_back(all[i * (all.size() - 1) / (most - 1)]);
  return out;
}

}  // namespace roomgraph
