// SPDX-License-Identifier: BSD-3-Clause
// Median clock offset at the beginning and the end of a recording.
#include "clock_offset.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "roomgraph/core/order_statistics.h"

namespace roomgraph {
namespace {

struct StampedOffset {
  double t = 0, offset = 0;  // s
  bool sure = false;         // the reference has no gap and no jump of its own here
};

double usualInterval(const std::vector<FilePlace>& places) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < places.size(); ++i) intervals.push_back(places[i].t - places[i - 1].t);
  return median(intervals);
}

double meanOf(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// The largest difference between the medians of the offsets before and behind a record, where it is clearly
// more than the offsets scatter there. The medians are the same for several records in a row; the means
// differ most at the step.
void findStep(const std::vector<StampedOffset>& offsets, ClockOffset& out) {
  constexpr std::ptrdiff_t kSide = 8;  // records on each side
  constexpr double kLeast_s = 0.2, kScatters = 3;
  std::vector<double> sure, times;
  for (const auto& one : offsets)
    if (one.sure) {
      sure.push_back(one.offset);
      times.push_back(one.t);
    }
  double largest = 0;
  for (std::ptrdiff_t i = kSide; i + kSide <= static_cast<std::ptrdiff_t>(sure.size()); ++i) {
    const std::vector<double> before(sure.begin() + i - kSide, sure.begin() + i);
    const std::vector<double> behind(sure.begin() + i, sure.begin() + i + kSide);
    const double step = median(behind) - median(before), means = std::abs(meanOf(behind) - meanOf(before));
    const double scatter =
        quantile(before, 0.9) - quantile(before, 0.1) + quantile(behind, 0.9) - quantile(behind, 0.1);
    if (std::abs(step) < std::max(kLeast_s, kScatters * scatter) || means <= largest) continue;
    largest = means;
    out.step_s = step;
    out.step_time = times[static_cast<std::size_t>(i)];
  }
}

}  // namespace

std::optional<ClockOffset> clockOffset(const std::vector<FilePlace>& reference,
                                       const std::vector<FilePlace>& sensor) {
  constexpr std::size_t kLeast = 5, kParts = 4;
  constexpr double kGapIntervals = 3;
  const double interval = usualInterval(reference);
  std::vector<double> offsets;
  std::vector<StampedOffset> stamped;
  for (const FilePlace& record : sensor) {
    const auto after =
        std::upper_bound(reference.begin(), reference.end(), record.index,
                         [](int index, const FilePlace& other) { return index < other.index; });
    if (after == reference.begin() || after == reference.end()) continue;
    const double between = after->t - (after - 1)->t;
    offsets.push_back(record.t - 0.5 * ((after - 1)->t + after->t));
    stamped.push_back({record.t, offsets.back(), between >= 0 && between < kGapIntervals * interval});
  }
  if (offsets.size() < kLeast) return std::nullopt;
  const auto part = static_cast<std::ptrdiff_t>(std::max<std::size_t>(1, offsets.size() / kParts));
  ClockOffset out{.first_s = median({offsets.begin(), offsets.begin() + part}),
                  .last_s = median({offsets.end() - part, offsets.end()})};
  findStep(stamped, out);
  return out;
}

}  // namespace roomgraph
