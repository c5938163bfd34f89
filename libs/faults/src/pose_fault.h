// SPDX-License-Identifier: BSD-3-Clause
// Fault of a sensor that is not where the recording says.
#pragma once

#include "fault.h"
#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// The recorded pose of the sensor on the robot is off: moved by `error`'s translation and turned by its
/// rotation about the sensor's own place, both along the robot's axes. What it measures stays.
class WrongExtrinsicsFault : public Fault {
 public:
  WrongExtrinsicsFault(FaultySensor sensor, const Pose3& error, FaultWindow window)
      : sensor_(sensor), error_(error), window_(window) {}
  PassingRecords pass(PassingRecord record) override;

 private:
  FaultySensor sensor_;
  Pose3 error_;
  FaultWindow window_;
};

}  // namespace roomgraph
