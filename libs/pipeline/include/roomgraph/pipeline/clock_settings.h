// SPDX-License-Identifier: BSD-3-Clause
// Clocks of sensors that a run found wrong, and sets when it begins anew.
#pragma once

#include <string>
#include <vector>

#include "roomgraph/datasets/calibration_file.h"
#include "roomgraph/datasets/rawlog_reader.h"
#include "roomgraph/datasets/rawlog_report.h"
#include "roomgraph/pipeline/front_ends.h"

namespace roomgraph {

/// What is added to the stamps of a sensor.
struct ClockSetting {
  MotionSensor sensor = MotionSensor::kLidar;
  std::string label;  ///< empty for wheels
  TimeOffset offset;
  bool jumped = false;  ///< only once the stamps have jumped by so much
  bool operator==(const ClockSetting&) const = default;
};

/// Those that differ from the others by more than they may be off by. Where some were set before, what is left.
std::vector<ClockSetting> wrongClocks(const FrontEnds& sensors);

/// Whether wrong clocks were wrong from the start or have jumped: others come apart, which no setting helps.
bool canBeSet(const SensorClocks& clocks);

/// With who has jumped, as the stamps show in the order of the file. Without those of clocks that were right before and have not.
std::vector<ClockSetting> withJumps(std::vector<ClockSetting> wrong, const SensorClocks& clocks, const ReadStatistics& read);

/// Adds to what is there.
void addClocks(const std::vector<ClockSetting>& found, std::vector<ClockSetting>& clocks);
void addClocks(const std::vector<ClockSetting>& clocks, RecordCorrections& corrections);

/// Whether stamps were corrected: a jump may not be found in the file.
bool isSet(const ClockSetting& clock, const ReadStatistics& read);

/// "its stamps are 0.100 s (+- 0.003) too late against those of the others", and whether the run corrected them.
Finding clockFinding(const ClockSetting& clock, bool set);

}  // namespace roomgraph
