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

  double duration() const { return kStep_s * static_cast<double>(instants_.size()); }
  /// Robot base for a robot; body frame of the camera (x forward, z up) for a hand-held one. Stays at the
  /// ends.
  Pose3 at(double seconds) const;

  /// Between two poses of a curve: which, and how far from the first of them, 0 to 1.
  struct Instant {
    std::size_t segment;
    double ratio;
  };

 private:
  static constexpr double kStep_s = 0.005;  ///< poses are interpolated between those of these instants

  Pose3 stateAt(std::size_t instant) const;

  std::vector<Pose3> curve_;
  std::vector<Instant> instants_;  ///< kStep_s apart; after them the curve's end
};

}  // namespace roomgraph
