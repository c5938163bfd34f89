// SPDX-License-Identifier: BSD-3-Clause
// What one step of the engine is about.
#pragma once

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <vector>

namespace roomgraph {

using ActionPtr = mrpt::obs::CActionCollection::Ptr;
using SensoryFramePtr = mrpt::obs::CSensoryFrame::Ptr;
using ObservationPtr = mrpt::obs::CObservation::Ptr;

/// An action with its sensory frame, or an observation; the others are null.
inline std::vector<mrpt::serialization::CSerializable::Ptr> objectsOf(const ActionPtr& action,
                                                                      const SensoryFramePtr& observations,
                                                                      const ObservationPtr& observation) {
  return {action, observations, observation};
}

/// Time of what was observed in the step, s; NaN when none has a stamp.
inline double timeOfStep(const SensoryFramePtr& observations, const ObservationPtr& observation) {
  if (observation && observation->timestamp != INVALID_TIMESTAMP)
    return mrpt::Clock::toDouble(observation->timestamp);
  if (observations)
    for (const auto& each : *observations)
      if (each && each->timestamp != INVALID_TIMESTAMP) return mrpt::Clock::toDouble(each->timestamp);
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace roomgraph
