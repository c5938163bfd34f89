// SPDX-License-Identifier: BSD-3-Clause
// RateClock: so many times a second at most, evenly spread over what comes.
#pragma once

namespace roomgraph {

/// Tells which of the records that come in order of time are to be worked on, at most `rate_hz` a second.
class RateClock {
 public:
  /// 0: every one.
  explicit RateClock(double rate_hz) : rate_hz_(rate_hz) {}

  /// Whether something is due at time `t`, s.
  bool due(double t) const {
    constexpr double kJitter_s = 0.002;  // of stamps: a camera at the wanted rate is not halved by it
    return rate_hz_ == 0 || t > period_end_s_ - kJitter_s;
  }
  /// It was done at time `t`, s.
  void ran(double t) {
    if (rate_hz_ == 0) return;
    // From the end of the last period, so that the mean rate is the wanted one; anew after a pause.
    const double period = 1 / rate_hz_;
    period_end_s_ = (t - period_end_s_ < period ? period_end_s_ : t) + period;
  }

 private:
  double rate_hz_;
  double period_end_s_ = 0;  ///< before it, nothing is due
};

}  // namespace roomgraph
