// SPDX-License-Identifier: BSD-3-Clause
// Whether wheels, images and scans measure the same movements: who contradicts the others, and whose pose on the robot is turned.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "roomgraph/estimation/motion.h"

namespace roomgraph {

enum class MotionSensor { kLidar, kCamera, kWheels };
constexpr std::array kMotionSensors = {MotionSensor::kLidar, MotionSensor::kCamera, MotionSensor::kWheels};
const char* toString(MotionSensor sensor);

/// One movement as each sensor saw it, in the order of kMotionSensors; nothing where one did not.
using MovementBySensor = std::array<std::optional<Movement>, kMotionSensors.size()>;

/// A time in which one sensor differed from both others, and these did not from each other; or from the only other one.
struct Contradiction {
  MotionSensor sensor;
  double from_t = 0, until_t = 0;        ///< s
  double off_m = 0, off_rad = 0;  ///< the largest differences from the others, of movements of some tenths of a second
  std::optional<MotionSensor> only_other = std::nullopt;  ///< the only other one: which of the two is wrong is not known
};

/// An angle with what it may be off by.
struct TurnedBy {
  double rad = 0, sigma_rad = 0;
};

/// Compares movements over the same times, on the floor.
class MovementAgreement {
 public:
  void compare(double from_t, double until_t, const MovementBySensor& seen);

  /// In the order of time; what goes on is one.
  const std::vector<Contradiction>& contradictions() const { return contradictions_; }
  /// By how much the ways that `sensor` saw are turned against those that `other` saw, where the robot drove straight on: the yaw error
  /// of its pose on the robot, if that of the other has none. Nothing where there were fewer than 20.
  std::optional<TurnedBy> turned(MotionSensor sensor, MotionSensor other) const;

 private:
  void add(const Contradiction& now);

  std::vector<Contradiction> contradictions_;
  std::array<std::optional<std::size_t>, 2 * kMotionSensors.size()> last_;  // contradiction of each, and of each with the next one alone
  std::array<std::vector<double>, kMotionSensors.size()> turns_;  // of each against the next one
};

}  // namespace roomgraph
