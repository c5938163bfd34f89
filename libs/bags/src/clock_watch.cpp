// SPDX-License-Identifier: BSD-3-Clause
// Falls of one topic's times, and what the other topics say of them.
#include "clock_watch.h"

#include <algorithm>

namespace roomgraph::bags {
namespace {

constexpr std::int64_t kLeastFall_ns = 1'000'000'000;  // messages that come late are not as late
constexpr std::int64_t kGoingOn_ns = 500'000'000;      // by which a fall is believed, or not
constexpr int kSpeaks = 2;  // messages of a topic: a single one may be from before the fall, or wrong

// So that sums of times are numbers: 2103, and from now back to 1970.
constexpr std::int64_t kLatest_ns = 4'200'000'000'000'000'000, kMostAdded_ns = 1'900'000'000'000'000'000;

}  // namespace

void ClockWatch::take(const std::string& stream, std::int64_t t_ns, bool decides,
                      const std::vector<std::uint64_t>& counts) {
  if (t_ns < 0 || t_ns > kLatest_ns) return;
  const auto [place, is_new] = clocks_.try_emplace(stream);
  Clock& clock = place->second;
  clock.decides = decides;
  if (is_new) clock.latest_ns = clock.before_ns = clock.held_ns = t_ns;
  if (!fall_) look(clock, t_ns, counts);
  if (clock.count == 0 || t_ns < clock.latest_ns - kLeastFall_ns / 2) {
    clock.first_ns = t_ns;
    clock.count = 0;
  }
  ++clock.count;
  clock.before_ns = clock.latest_ns;
  clock.latest_ns = t_ns;
  if (fall_ && decides && clock.count >= kSpeaks && t_ns - clock.first_ns >= kGoingOn_ns) decide();
}

// Of the last two times one may be far ahead, and wrong: the earlier counts.
void ClockWatch::look(const Clock& clock, std::int64_t t_ns, const std::vector<std::uint64_t>& counts) {
  if (t_ns >= std::min(clock.latest_ns, clock.before_ns) - kLeastFall_ns) return;
  const std::int64_t step = clock.latest_ns - clock.before_ns;
  const bool usual = step >= 0 && step < kLeastFall_ns;
  fall_ = ClockRestart{counts, clock.latest_ns + (usual ? step : 0) - t_ns};
  for (auto& [stream, other] : clocks_) {
    other.held_ns = other.latest_ns;
    other.count = 0;
    other.known = true;
  }
}

void ClockWatch::decide() {
  const auto speaks = [](const auto& entry) {
    return entry.second.known && entry.second.decides && entry.second.count >= kSpeaks;
  };
  const auto stayed = [&](const auto& entry) { return speaks(entry) && !entry.second.fell(); };
  const bool all = std::any_of(clocks_.begin(), clocks_.end(), speaks) &&
                   std::none_of(clocks_.begin(), clocks_.end(), stayed);
  if (all && fall_->back_ns <= kMostAdded_ns - added_ns_) {
    added_ns_ += fall_->back_ns;
    restarts_.push_back(*fall_);
  }
  fall_.reset();
}

void ClockWatch::finish() {
  if (fall_) decide();
}

}  // namespace roomgraph::bags
