// SPDX-License-Identifier: BSD-3-Clause
// Weight of measurements whose errors repeat.
#pragma once

#include <cstddef>

namespace roomgraph {

/// Weight of one of `count` measurements whose errors have this share of their variance in common. Together they are
/// worth as much as their mean, whose variance is (share + (1 - share) / count) times that of one.
inline double weightAmong(std::size_t count, double repeating_share) {
  return 1 / (1 + repeating_share * (static_cast<double>(count) - 1));
}

}  // namespace roomgraph
