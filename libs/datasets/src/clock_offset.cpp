// SPDX-License-Identifier: BSD-3-Clause
// Median clock offset at the beginning and the end of a recording.
#include "clock_offset.h"

#include <algorithm>

#include "roomgraph/core/order_statistics.h"

namespace roomgraph {

std::optional<ClockOffset> clockOffset(const std::vector<FilePlace>& reference,
                                       const std::vector<FilePlace>& sensor) {
  constexpr std::size_t kLeast = 5, kParts = 4;
  std::vector<double> offsets;
  for (const FilePlace& record : sensor) {
    const auto after =
        std::upper_bound(reference.begin(), reference.end(), record.index,
                         [](int index, const FilePlace& other) { return index < other.index; });
    if (after == reference.begin() || after == reference.end()) continue;
    offsets.push_back(record.t - 0.5 * ((after - 1)->t + after->t));
  }
  if (offsets.size() < kLeast) return std::nullopt;
  const auto part = static_cast<std::ptrdiff_t>(std::max<std::size_t>(1, offsets.size() / kParts));
  return ClockOffset{median({offsets.begin(), offsets.begin() + part}),
                     median({offsets.end() - part, offsets.end()})};
}

}  // namespace roomgraph
