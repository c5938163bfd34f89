// SPDX-License-Identifier: BSD-3-Clause
// Parts of a bag by counts of messages, and sums of what its clocks were set back by.
#include "continued_clock.h"

#include <algorithm>

namespace roomgraph::bags {
namespace {

constexpr std::int64_t kApart_ns = 10'000'000'000;      // more than sensors are late
constexpr std::int64_t kStraggling_ns = 1'000'000'000;  // less than clocks are set back by
constexpr std::int64_t kLatestReception_ns =
    7'200'000'000'000'000'000;  // damaged ones are no numbers to add to

}  // namespace

void ClockParts::follow(std::size_t topic, std::uint64_t count, std::int64_t now_ns) {
  for (; part_ < restarts_.size(); ++part_) {
    const auto& before = restarts_[part_].before;
    if (topic < before.size() && count < before[topic]) return;
    restarted_ns_ = now_ns;
  }
}

std::size_t ClockParts::partOf(const std::string& stream, std::int64_t t_ns, std::int64_t now_ns) {
  auto& [last_ns, part] = streams_.try_emplace(stream, Stream{t_ns, part_}).first->second;
  const bool straggles =
      now_ns < restarted_ns_ + kStraggling_ns && t_ns >= last_ns && t_ns < last_ns + kStraggling_ns;
  if (!straggles) part = part_;
  last_ns = t_ns;
  return part;
}

std::int64_t ClockParts::addedNs(std::size_t part) const {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < part; ++i) sum += restarts_[i].back_ns;
  return sum;
}

ContinuedClock::ContinuedClock(std::vector<ClockRestart> stamps, std::vector<ClockRestart> receptions)
    : stamps_(std::move(stamps)), receptions_(std::move(receptions)) {}

void ContinuedClock::follow(std::size_t topic, std::int64_t received_ns) {
  if (counts_.size() <= topic) counts_.resize(topic + 1);
  receptions_.follow(topic, counts_[topic], now_ns_);
  const auto plausible_ns = std::clamp(received_ns, std::int64_t{0}, kLatestReception_ns);
  received_ns_ =
      plausible_ns + receptions_.addedNs(receptions_.partOf(std::to_string(topic), plausible_ns, now_ns_));
  now_ns_ = std::max(now_ns_, received_ns_);
  stamps_.follow(topic, counts_[topic], now_ns_);
  ++counts_[topic];
}

std::int64_t ContinuedClock::apartNs(std::size_t part) const {
  return addedNs(part) + static_cast<std::int64_t>(part) * kApart_ns;
}

}  // namespace roomgraph::bags
