// SPDX-License-Identifier: BSD-3-Clause
// Kind of sensor by class of the observation; copies.
#include "passing_record.h"

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationOdometry.h>

#include "roomgraph/observations/CObservationDetections.h"
#include "roomgraph/observations/detection_comment.h"

namespace roomgraph {

std::string PassingRecord::label() const {
  const auto read = unpacked(observation);  // detections in a comment have their label in its text
  const std::string name = read ? (*read)->sensorLabel : observation->sensorLabel;
  if (!name.empty()) return name;
  const std::string class_name = observation->GetRuntimeClass()->className;
  return class_name.substr(class_name.rfind(':') + 1);
}

PassingRecord PassingRecord::clone() const {
  PassingRecord copy = *this;
  copy.observation = std::dynamic_pointer_cast<mrpt::obs::CObservation>(observation->duplicateGetSmartPtr());
  return copy;
}

FaultySensor sensorOf(const mrpt::obs::CObservation& observation) {
  using namespace mrpt::obs;
  if (dynamic_cast<const CObservation3DRangeScan*>(&observation) ||
      dynamic_cast<const CObservationDetections*>(&observation))
    return FaultySensor::kCamera;
  if (dynamic_cast<const CObservation2DRangeScan*>(&observation)) return FaultySensor::kLidar;
  if (dynamic_cast<const CObservationOdometry*>(&observation)) return FaultySensor::kOdometry;
  const auto* comment = dynamic_cast<const CObservationComment*>(&observation);
  return comment && holdsDetections(*comment) ? FaultySensor::kCamera : FaultySensor::kOther;
}

}  // namespace roomgraph
