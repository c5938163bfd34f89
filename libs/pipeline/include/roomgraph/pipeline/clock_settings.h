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

/// Those of the wrong ones that can be set: from a jump on that the stamps show in the order of the file, or from the start where a clock
/// was never right; what comes apart slowly cannot. The sensor that jumped is set, though another one seems wrong. `jumps`: until now.
std::vector<ClockSetting> settable(const std::vector<ClockSetting>& wrong, const SensorClocks& clocks, const StampJumpsBySensor& jumps);

/// The same clocks with that of the camera as it is: those of the others are set instead. Boxes that were recorded elsewhere are found by
/// the stamps of images. Without a camera that has jumped, which cannot be.
std::vector<ClockSetting> withoutCamera(const std::vector<ClockSetting>& clocks, const FrontEnds& sensors);

/// Adds to what is there.
void addClocks(const std::vector<ClockSetting>& found, std::vector<ClockSetting>& clocks);
void addClocks(const std::vector<ClockSetting>& clocks, RecordCorrections& corrections);

/// "its stamps are 0.100 s (+- 0.003) too late against those of the others", and whether the run corrected them.
Finding clockFinding(const ClockSetting& clock, bool set);

}  // namespace roomgraph
