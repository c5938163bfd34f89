// SPDX-License-Identifier: BSD-3-Clause
// Statistics of wheel odometry: path, turns, jumps, and times at which it stands still.
#pragma once

#include <optional>
#include <vector>

#include "roomgraph/datasets/rawlog_report.h"

namespace roomgraph {

/// Odometry poses of one sensor in the order of the file.
class OdometryStatistics {
 public:
  /// t in s; nothing when the reading has no stamp.
  void add(std::optional<double> t, const Pose2& pose);
  /// Path, turns and jumps.
  OdometrySummary report() const { return summary_; }
  /// Spans of at least kLeast_s in which the pose does not change at all, in order of time.
  std::vector<OdometryStandstill> standstills() const;

  static constexpr double kLeast_s = 2;

 private:
  OdometrySummary summary_;
  std::optional<Pose2> last_;
  std::optional<double> last_t_;
  OdometryStandstill current_;
  std::vector<OdometryStandstill> standstills_;
};

}  // namespace roomgraph
