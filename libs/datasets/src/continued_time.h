// SPDX-License-Identifier: BSD-3-Clause
// Time that goes on where the clock of all sensors is set back.
#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "roomgraph/core/order_statistics.h"
#include "roomgraph/datasets/clock_set_back.h"

namespace roomgraph {

/// Look-ahead buffer of records in file order that tells when the clock of a computer was set back while it recorded: the next stamps
/// of every sensor are older than expected by about the same time, and go on from there for two seconds. Believed, all records would be "older than
/// the one before" until the clock has caught up. A clock that is set forward looks like a pause, and is left alone.
/// Records wait only where a stamp is much older than the last one of its sensor, and at most kLongest of them: two seconds of 150 a second.
template <class T>
class ContinuedTime {
 public:
  struct Item {
    std::string sensor;  ///< empty: it says nothing of clocks
    double t = 0;        ///< s, as recorded
    T record;
    double added_s = 0;  ///< to its stamp, so that time goes on
  };

  void push(std::string sensor, double t, T record) {
    clocked_ += !sensor.empty();
    items_.push_back({std::move(sensor), t, std::move(record)});
  }

  /// The next record, when it is known what its stamp is worth; `complete`: none will be pushed any more.
  std::optional<Item> pop(bool complete) {
    if (items_.empty()) return std::nullopt;
    const bool too_many = clocked_ >= kLongest;
    const auto back_s = given_up_ ? std::optional(0.) : setBackBy(complete || too_many);
    if (!back_s) return std::nullopt;
    given_up_ = given_up_ || too_many;
    if (*back_s > 0) {
      found_.push_back({items_.front().t, *back_s});
      added_s_ += *back_s;
      for (auto& [name, clock] : clocks_) clock.t -= *back_s;
    }
    Item item = std::move(items_.front());
    items_.pop_front();
    follow(item);
    item.added_s = added_s_;
    return item;
  }

  const std::vector<ClockSetBack>& found() const { return found_; }

 private:
  static constexpr double kLeast_s = 1;  // buffers of logs that several processes write are shorter
  static constexpr double kSilent_s = 5, kSilentIntervals = 10;  // of a sensor that is there no more, at most
  static constexpr double kLasting_s = 2;  // without a jump forward
  static constexpr double kAhead = 0.5;    // share of a jump that a jump forward has at least
  static constexpr std::size_t kLongest = 300, kSteps = 16, kLeastSteps = 8;

  struct Clock {
    double t = 0;                ///< of the last record; as recorded, were the clock set back all the time
    std::deque<double> steps_s;  ///< from each of the latest records to the next
    int older = 0;               ///< records since that were older, and were not believed

    double interval() const { return steps_s.empty() ? 0 : median({steps_s.begin(), steps_s.end()}); }
  };

  void follow(const Item& item) {
    if (item.sensor.empty()) return;
    --clocked_;
    if (!std::isfinite(item.t)) return;
    const auto [place, is_new] = clocks_.try_emplace(item.sensor, Clock{item.t});
    Clock& clock = place->second;
    if (item.t > clock.t) {
      clock.steps_s.push_back(item.t - clock.t);
      if (clock.steps_s.size() > kSteps) clock.steps_s.pop_front();
      clock.t = item.t;
      clock.older = 0;
      given_up_ = false;
    } else if (!is_new) {
      ++clock.older;
    }
  }

  std::vector<double> stampsOf(const std::string& sensor) const {
    std::vector<double> out;
    for (const Item& item : items_)
      if (item.sensor == sensor && std::isfinite(item.t)) out.push_back(item.t);
    return out;
  }

  // How much older than expected a stamp is that is the next one of its sensor.
  static double lateness(const Clock& clock, double t) { return clock.t + clock.interval() * (clock.older + 1) - t; }

  // By how much all clocks are set back at the next record; 0: they are not. Nothing: it depends on what comes.
  std::optional<double> setBackBy(bool decide) const {
    const Item& next = items_.front();
    const auto known = clocks_.find(next.sensor);
    if (known == clocks_.end() || known->second.steps_s.size() < kLeastSteps || !(next.t < known->second.t - kLeast_s)) return 0;
    const double own_s = lateness(known->second, next.t);
    const auto stamps = stampsOf(next.sensor);
    // Records that were written late, or in another order, come before or behind a jump forward.
    const auto isRegular = [longest_s = known->second.interval() + kAhead * own_s](double step_s) { return step_s >= 0 && step_s < longest_s; };
    if (!std::all_of(known->second.steps_s.begin(), known->second.steps_s.end(), isRegular)) return 0;
    for (std::size_t i = 1; i < stamps.size(); ++i)
      if (!isRegular(stamps[i] - stamps[i - 1])) return 0;
    const double waited_s = stamps.back() - stamps.front();
    double finest_s = known->second.interval(), back_s = own_s;
    bool all = waited_s >= kLasting_s;
    for (const auto& [sensor, clock] : clocks_) {
      if (sensor == next.sensor || clock.steps_s.empty()) continue;
      const auto others = stampsOf(sensor);
      if (others.empty()) {
        all = all && waited_s >= std::min(kSilent_s, kSilentIntervals * clock.interval());
        continue;
      }
      const double late_s = lateness(clock, others.front());
      if (std::abs(late_s - own_s) > std::abs(late_s)) return 0;
      if (clock.interval() >= finest_s) continue;
      finest_s = clock.interval();
      back_s = late_s;
    }
    if (all) return back_s;
    return decide ? std::optional(0.) : std::nullopt;
  }

  std::deque<Item> items_;
  std::size_t clocked_ = 0;  ///< of them, records that say something of clocks
  std::map<std::string, Clock> clocks_;
  bool given_up_ = false;  ///< too many waited: none does until time goes on by itself
  double added_s_ = 0;
  std::vector<ClockSetBack> found_;
};

}  // namespace roomgraph
