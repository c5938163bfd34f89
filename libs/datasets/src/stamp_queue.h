// SPDX-License-Identifier: BSD-3-Clause
// Queue of records that detects isolated wrong time stamps.
#pragma once

#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace roomgraph {

/// Reason for leaving out a record, behind its class.
inline constexpr const char* kStampIsWrong =
    "time stamp is more than a minute from those before and after it";

/// Look-ahead buffer of records in file order that detects single corrupt time stamps: those far from the
/// stamps before and after. Believed, one would make every later record of its sensor "older than the one
/// before". After a gap in the recording, in contrast, the following stamps agree with each other.
/// Records are buffered only until this is decided: for one or two more of their sensor, and at most
/// kLongest in all.
template <class T>
class StampQueue {
 public:
  struct Item {
    std::string sensor;
    double t = 0;  ///< s
    T record;
    bool stamp_is_wrong = false;
  };

  void push(std::string sensor, double t, T record) {
    items_.push_back({std::move(sensor), t, std::move(record)});
  }
  bool empty() const { return items_.empty(); }

  /// The next record, when it is known what its stamp is worth; `complete`: none will be pushed any more.
  std::optional<Item> pop(bool complete) {
    if (items_.empty()) return std::nullopt;
    const auto wrong = isWrong(complete);
    if (!wrong) return std::nullopt;
    Item item = std::move(items_.front());
    items_.pop_front();
    item.stamp_is_wrong = *wrong;
    if (!*wrong) last_[item.sensor] = latest_ = item.t;
    return item;
  }

 private:
  static constexpr double kFar_s = 60;
  static constexpr std::size_t kLongest = 64;
  static bool far(double a, double b) { return std::abs(a - b) > kFar_s; }

  // Nothing: it depends on what comes.
  std::optional<bool> isWrong(bool complete) const {
    const bool decide = complete || items_.size() >= kLongest;
    const Item& item = items_.front();
    const auto own = last_.find(item.sensor);
    const double before = own != last_.end() ? own->second : latest_;  // NaN: it is the very first
    if (!std::isnan(before) && !far(item.t, before)) return false;
    // After a pause of all sensors the slow ones come back later than the fast ones.
    if (!std::isnan(latest_) && !far(item.t, latest_)) return false;
    double next[2];
    int count = 0;
    for (auto other = items_.begin() + 1; other != items_.end() && count < 2; ++other)
      if (other->sensor == item.sensor) next[count++] = other->t;
    if (count > 0 && !far(item.t, next[0])) return false;
    if (std::isnan(before)) {
      // The first and the second disagree: the third decides.
      if (count < 2) return decide ? std::optional(false) : std::nullopt;
      return !far(next[0], next[1]);
    }
    // The very last of its sensor is given up; one that just has to wait too long has nothing against it.
    if (count == 0) return decide ? std::optional(complete) : std::nullopt;
    const double around = std::abs(next[0] - before);
    return around < std::abs(item.t - before) && around < std::abs(item.t - next[0]);
  }

  std::deque<Item> items_;
  std::map<std::string, double> last_;
  double latest_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace roomgraph
