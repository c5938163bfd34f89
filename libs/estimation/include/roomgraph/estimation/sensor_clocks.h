// SPDX-License-Identifier: BSD-3-Clause
// Which of lidar, camera and wheels has another clock than the others.
#pragma once

#include <array>
#include <limits>
#include <optional>

#include "roomgraph/estimation/clock_comparison.h"
#include "roomgraph/estimation/movement_agreement.h"

namespace roomgraph {

/// What is to be added to the stamps of each sensor, in the order of kMotionSensors; 0 for the one whose clock the others get.
using TimeOffsets = std::array<TimeOffset, kMotionSensors.size()>;

/// Offsets of the sensors' clocks as the data show them, while a run goes on.
class SensorClocks {
 public:
  /// Of what they have seen; empty for a sensor that is not there. One that gave nothing for five seconds counts no more. What the camera
  /// saw until `predicted_t` was only predicted.
  void compare(const Trajectory& lidar, const Trajectory& camera, const Trajectory& wheels,
               double predicted_t = -std::numeric_limits<double>::infinity());
  /// Whether it counts.
  bool isThere(MotionSensor sensor) const { return there_[static_cast<std::size_t>(sensor)]; }

  /// The clock that most others agree with counts as right; of several that of the lidar, or of the one of wheels and camera whose offset
  /// from the lidar is known better, or of the wheels. Nothing until all offsets are known.
  std::optional<TimeOffsets> offsets() const;
  /// The same, where one is wrong by more than it may be off by, and well known; the others are 0.
  std::optional<TimeOffsets> wrong() const;
  /// Whether there was a time when this one was right.
  bool agreed(MotionSensor sensor) const { return agreed_[static_cast<std::size_t>(sensor)]; }
  /// Whether one has jumped.
  bool jumped() const { return jumped_; }

 private:
  std::optional<TimeOffsets> againstFirst() const;

  std::array<bool, kMotionSensors.size()> there_{}, agreed_{};
  bool jumped_ = false;
  ClockComparison camera_lidar_, wheels_lidar_, camera_wheels_;
};

}  // namespace roomgraph
