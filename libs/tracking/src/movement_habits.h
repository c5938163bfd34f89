// SPDX-License-Identifier: BSD-3-Clause
// MovementHabits: directions in which a robot hardly ever moves, learnt while features tell.
#pragma once

#include <deque>

#include "roomgraph/geometry/pose.h"

namespace roomgraph::tracking {

/// A robot on wheels drives ahead and turns; sideways of its arcs, upwards and in tilt it moves as little as its floor is uneven.
/// One that can drive sideways shows that it does.
class MovementHabits {
 public:
  /// A movement of the robot (x ahead, z up) in so many seconds that was well measured: some decimetres.
  void learn(const Pose3& movement, double seconds);
  /// Standard deviations of translation (m) and rotation (rad) along and about the robot's axes that add up, as variances, over
  /// the square root of a second: of a drive along an arc, sideways of it. Infinite ahead and about z, and zero elsewhere until
  /// enough was learnt.
  Vector6d scatter() const;
  /// A movement of the robot as it is expected to go on: without what it hardly ever does.
  Pose3 expected(const Pose3& movement) const;

 private:
  std::deque<Vector6d> latest_;  ///< per square root of a second
};

}  // namespace roomgraph::tracking
