// SPDX-License-Identifier: BSD-3-Clause
// A run that begins anew once it knows how to set the clocks of the sensors.
#pragma once

#include <string>
#include <vector>

#include "roomgraph/pipeline/clock_settings.h"
#include "roomgraph/pipeline/replay.h"

namespace roomgraph {

/// How often a run has begun, and with which clocks.
class RunBeginnings {
 public:
  RunBeginnings() = default;
  /// Goes on in the last beginning of an unfinished run.
  RunBeginnings(int begun, std::vector<ClockSetting> clocks) : begun_(begun), clocks_(std::move(clocks)) {}

  /// The run begins anew, with what was found.
  void again();
  /// After a record: whether it is to. Not until the same clocks have been wrong for five seconds or the recording has `ended`, not for a
  /// little that is left, not when the configuration says that clocks stay as they are. `images_stay`: their stamps are not to change.
  bool shallBegin(const SemanticSlam& slam, const RawlogReader& reader, const ReplayState& now, bool images_stay, bool ended = false);

  int begun() const { return begun_; }
  const std::vector<ClockSetting>& clocks() const { return clocks_; }
  /// Why, in a line for each clock.
  std::vector<std::string> reasons(const ReplayState& replayed) const;
  /// The longest that is added to a stamp, s.
  double longestOffset() const;

 private:
  int begun_ = 1;
  std::vector<ClockSetting> clocks_;
  std::vector<ClockSetting> found_;  ///< when it shall begin anew
  std::vector<MotionSensor> wrong_;  ///< sensors that are, since wrong_since_s_
  double wrong_since_s_ = 0;
};

}  // namespace roomgraph
