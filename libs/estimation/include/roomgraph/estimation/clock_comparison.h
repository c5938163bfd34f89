// SPDX-License-Identifier: BSD-3-Clause
// By how much the clocks of two sensors differ, told by the turns, starts and stops that both measured.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "roomgraph/observations/trajectory.h"

namespace roomgraph {

/// What is to be added to the stamps of one sensor so that they are of the clock of another, s.
struct TimeOffset {
  double seconds = 0, sigma = 0;
  bool operator==(const TimeOffset&) const = default;
};

/// Likelihood of every offset up to a second, of the differences between movements of one sensor and those of the other at that offset
/// (Cauchy's distribution: slips count little). Forgets: what it says is of the last minute of driving, or of the time since a clock
/// jumped.
class ClockComparison {
 public:
  ClockComparison();

  /// Movements that both have seen to their end, and a second beyond, since the last call, that the sensor began after `after_t`. Both
  /// trajectories have only grown since then. Returns whether a clock has jumped.
  bool compare(const Trajectory& sensor, const Trajectory& reference, double after_t = -std::numeric_limits<double>::infinity());
  /// What was seen until now is of clocks that may have jumped.
  void forget();
  /// Nothing while several offsets would do, and before 30 movements told something.
  std::optional<TimeOffset> offset() const;

 private:
  using Costs = std::vector<std::vector<double>>;  // negative log likelihoods, by noise and offset

  void learn(const Trajectory& sensor, const Trajectory& reference, double from_t, double until_t);
  bool hasJumped();

  Costs lasting_, recent_;
  std::size_t next_ = 0;       // pose of the sensor from which on nothing was compared
  int told_ = 0;               // movements that did
};

}  // namespace roomgraph
