// SPDX-License-Identifier: BSD-3-Clause
// A run that begins anew once it knows how to set the clocks of the sensors, and their poses on the robot.
#pragma once

#include <string>
#include <vector>

#include "roomgraph/pipeline/clock_settings.h"
#include "roomgraph/pipeline/mount_settings.h"
#include "roomgraph/pipeline/replay.h"

namespace roomgraph {

/// What is not to be set.
struct WhatStays {
  bool stamps_of_images = false, poses = false;
};

/// How often a run has begun, and with which clocks and poses of sensors.
class RunBeginnings {
 public:
  RunBeginnings() = default;
  /// Goes on in the last beginning of an unfinished run.
  RunBeginnings(int begun, std::vector<ClockSetting> clocks, std::vector<MountSetting> mounts)
      : begun_(begun), clocks_(std::move(clocks)), mounts_(std::move(mounts)) {}

  /// The run begins anew, with what was found.
  void again();
  /// After a record: whether it is to. Not until the same sensors have been wrong for five seconds or the recording has `ended`, not for a
  /// little that is left, not when the configuration says that clocks or poses stay as they are. Poses are judged once clocks are right.
  bool shallBegin(const SemanticSlam& slam, const RawlogReader& reader, const ReplayState& now, const WhatStays& stays, bool ended = false);

  int begun() const { return begun_; }
  const std::vector<ClockSetting>& clocks() const { return clocks_; }
  const std::vector<MountSetting>& mounts() const { return mounts_; }
  /// Adds what was set; time goes on where all clocks are set back only where stamps of images need not stay.
  void correct(ReadOptions& reading, const WhatStays& stays) const;
  /// Why, in a line for each clock and pose.
  std::vector<std::string> reasons(const ReplayState& replayed) const;
  /// The longest that is added to a stamp, s.
  double longestOffset() const;

 private:
  int begun_ = 1;
  std::vector<ClockSetting> clocks_, found_clocks_;  ///< those that are found are for when it begins anew
  std::vector<MountSetting> mounts_, found_mounts_;
  std::vector<std::string> wrong_;  ///< what is, since wrong_since_s_
  double wrong_since_s_ = 0, looked_s_ = -1e300;
};

}  // namespace roomgraph
