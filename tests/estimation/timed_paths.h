// SPDX-License-Identifier: BSD-3-Clause
// A robot that turns, drives and stops, as sensors with clocks of their own see it.
#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "roomgraph/core/random.h"
#include "roomgraph/observations/trajectory.h"

namespace roomgraph::test {

/// What happens for some seconds, of a drive that is drawn: stops, straight ways, turns on the spot, arcs.
class Drive {
 public:
  Drive(double seconds, unsigned seed) {
    Random random(seed);
    for (double t = 0; t < seconds; t += kPart_s) {
      const int kind = static_cast<int>(random.uniform(0, 4));
      parts_.push_back({kind == 1 || kind == 3 ? random.uniform(-0.2, 0.5) : 0, kind >= 2 ? random.uniform(-0.9, 0.9) : 0});
    }
    for (double t = 0; t < seconds; t += kTick_s) poses_.push_back(poses_.empty() ? Pose2{} : poses_.back() * moved(t));
  }

  Pose2 at(double t) const {
    const auto tick = static_cast<std::size_t>(std::clamp(t / kTick_s, 0.0, static_cast<double>(poses_.size() - 1)));
    return poses_[tick];
  }
  double seconds() const { return static_cast<double>(poses_.size()) * kTick_s; }

 private:
  struct Part {
    double speed = 0, turn_rate = 0;
  };
  static constexpr double kPart_s = 1.3, kTick_s = 0.001;

  Pose2 moved(double t) const {
    const Part& part = parts_[std::min(parts_.size() - 1, static_cast<std::size_t>(t / kPart_s))];
    return {part.speed * kTick_s, 0, part.turn_rate * kTick_s};
  }

  std::vector<Part> parts_;
  std::vector<Pose2> poses_;
};

/// Odometry of a sensor whose stamps are late by so much at every time.
struct Clockwork {
  double rate_hz = 10, noise_rad = 0.001, noise_m = 0.001;  ///< noise of a step
  std::function<double(double t)> late_s = [](double) { return 0.0; };
};

inline Trajectory seenBy(const Drive& drive, const Clockwork& sensor, unsigned seed) {
  Random random(seed);
  Trajectory out;
  Pose2 seen, before = drive.at(0);
  for (double t = 0; t < drive.seconds(); t += 1 / sensor.rate_hz) {
    const Pose2 now = drive.at(t);
    const Pose2 step = before.inverse() * now;
    seen = seen * Pose2{step.x + sensor.noise_m * random.normal(), step.y, step.yaw + sensor.noise_rad * random.normal()};
    before = now;
    const double stamp = t + sensor.late_s(t);
    if (out.empty() || stamp > out.lastTime()) out.add(stamp, toPose3(seen));
  }
  return out;
}

inline std::function<double(double)> alwaysLate(double seconds) {
  return [seconds](double) { return seconds; };
}

}  // namespace roomgraph::test
