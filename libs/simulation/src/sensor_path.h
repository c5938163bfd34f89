// SPDX-License-Identifier: BSD-3-Clause
// True trajectory of a robot or hand-held camera through given points.
#pragma once

#include <vector>

#include "roomgraph/geometry/pose.h"
#include "roomgraph/simulation/world.h"

namespace roomgraph {

/// Ground-truth trajectory: a smooth spline near the given points with a time law that respects the
/// limits of speed, turn rate and acceleration, for a robot or a hand-held camera. Poses are in the
/// plan's frame.
class SensorPath {
 public:
  explicit SensorPath(const RobotPathSpec& spec);
  explicit SensorPath(const HandheldSpec& spec);

  double duration() const { return states_.empty() ? 0 : step_s_ * static_cast<double>(states_.size() - 1); }
  /// Robot base for a robot; body frame of the camera (x forward, z up) for a hand-held one. Stays at the
  /// ends.
  Pose3 at(double seconds) const;

 private:
  double step_s_ = 0.005;  ///< states are interpolated between these instants
  std::vector<Pose3> states_;
};

}  // namespace roomgraph
