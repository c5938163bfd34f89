// SPDX-License-Identifier: BSD-3-Clause
// Records on their way from one rawlog into another.
#pragma once

#include <mrpt/obs/CObservation.h>

#include <string>
#include <vector>

namespace roomgraph {

/// What faults tell apart.
enum class FaultySensor {
  kCamera,  ///< RGB-D images, and detections that were recorded with them
  kLidar,
  kOdometry,
  kOther
};

/// A record on its way. Whoever changes the observation clears the bytes.
struct PassingRecord {
  double t = 0;  ///< as recorded, s after the first stamp of the recording; NaN: it has no stamp
  FaultySensor sensor = FaultySensor::kOther;
  mrpt::obs::CObservation::Ptr observation;
  std::string bytes;  ///< the observation as serialised in the input; empty: it has to be made anew

  /// What it is counted under: the sensor's label, or the class where there is none.
  std::string label() const;
  /// With an observation of its own.
  PassingRecord clone() const;
};

using PassingRecords = std::vector<PassingRecord>;

FaultySensor sensorOf(const mrpt::obs::CObservation& observation);

/// Seconds in which a fault acts.
struct FaultWindow {
  double from_s = 0, to_s = 0;  ///< infinity: to the end
  bool contains(double t) const { return t >= from_s && t < to_s; }
};

}  // namespace roomgraph
