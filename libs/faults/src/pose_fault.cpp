// SPDX-License-Identifier: BSD-3-Clause
// Error added to the recorded pose of a sensor.
#include "pose_fault.h"

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>

namespace roomgraph {

PassingRecords WrongExtrinsicsFault::pass(PassingRecord record) {
  const bool placed = dynamic_cast<mrpt::obs::CObservation3DRangeScan*>(record.observation.get()) ||
                      dynamic_cast<mrpt::obs::CObservation2DRangeScan*>(record.observation.get());
  if (placed && record.sensor == sensor_ && window_.contains(record.t)) {
    mrpt::poses::CPose3D recorded;
    record.observation->getSensorPose(recorded);
    const Pose3 before = toPose3(recorded);
    Pose3 after = before;
    after.translation() += error_.translation();
    after.linear() = error_.linear() * before.linear();
    record.observation->setSensorPose(toMrpt(after));
    changed(record);
  }
  return one(std::move(record));
}

}  // namespace roomgraph
