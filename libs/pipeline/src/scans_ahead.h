// SPDX-License-Identifier: BSD-3-Clause
// ScansAhead: scans of a robot without a camera, matched before their turn.
#pragma once

#include <memory>
#include <optional>

#include "roomgraph/core/read_ahead.h"
#include "roomgraph/datasets/record_stream.h"
#include "roomgraph/estimation/motion.h"
#include "roomgraph/lidar/scan_matcher.h"

namespace roomgraph {

/// Matches scans on the thread that reads ahead, until an image comes: from then on people in images are left out of the
/// scans, and the camera predicts. The matcher gets the same scans in the same order with the same predictions as in their turn:
/// the same bits.
class ScansAhead {
 public:
  /// `wheels`: noise of the odometry; nothing: it predicts nothing.
  ScansAhead(std::shared_ptr<ScanMatcher> matcher, const std::optional<MotionNoise>& wheels);

  /// Takes the records in their order, from the first one of the run on.
  void see(const Record& record);
  /// What came of the scan of that time, if it was matched. Another thread may ask.
  std::optional<ScanMatch> take(double t) { return matches_.take(t); }

 private:
  void match(const Scan& scan);

  std::shared_ptr<ScanMatcher> matcher_;
  bool wheels_predict_, over_ = false;
  MotionSource wheels_;
  std::optional<double> last_t_;
  Foreseen<ScanMatch> matches_;
};

}  // namespace roomgraph
