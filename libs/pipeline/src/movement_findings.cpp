// SPDX-License-Identifier: BSD-3-Clause
// Words for contradictions and turned sensors.
#include "movement_findings.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

#include "roomgraph/geometry/degree.h"

namespace roomgraph {
namespace {

constexpr double kLong_s = 2;  // a contradiction that lasts spoils more than its moment
constexpr double kTurned_rad = 3 * kDegree, kTurnedSigmas = 5;

const char* reasonOf(MotionSensor sensor) {
  switch (sensor) {
    case MotionSensor::kWheels: return "wheels slip or are lifted, or the robot is pushed: what they measure counts less there";
    case MotionSensor::kCamera: return "pictures full of what moves or repeats mislead: what they measure counts less there";
    case MotionSensor::kLidar: return "scans full of what moves, or along bare corridors, mislead: what they measure counts less there";
  }
  return "";
}

std::optional<Finding> contradictionsOf(MotionSensor sensor, const std::vector<Contradiction>& all, double start_t) {
  double seconds = 0, off_m = 0, off_rad = 0, first_t = 0;
  int times = 0;
  for (const Contradiction& one : all) {
    if (one.sensor != sensor) continue;
    if (times++ == 0) first_t = one.from_t;
    seconds += one.until_t - one.from_t;
    off_m = std::max(off_m, one.off_m);
    off_rad = std::max(off_rad, one.off_rad);
  }
  if (times == 0) return std::nullopt;
  char text[200];
  std::snprintf(text, sizeof text, "contradicts both other sensors%s for %.1f s, first from t = %.1f s on, by up to %.2f m and %.1f deg",
                times > 1 ? (" " + std::to_string(times) + " times,").c_str() : "", seconds, first_t - start_t, off_m, off_rad / kDegree);
  return Finding{seconds >= kLong_s ? Severity::kWarning : Severity::kNote, text, toString(sensor), reasonOf(sensor)};
}

bool isTurned(const std::optional<TurnedBy>& by) {
  return by && std::abs(by->rad) > std::max(kTurned_rad, kTurnedSigmas * by->sigma_rad);
}

Finding turnedFinding(MotionSensor sensor, const TurnedBy& by, const std::string& others) {
  char text[200];
  std::snprintf(text, sizeof text, "its way is turned by %.1f deg (+- %.1f) against that of %s", by.rad / kDegree, by.sigma_rad / kDegree, others.c_str());
  return {Severity::kWarning, text, toString(sensor), "the yaw of its recorded pose on the robot is wrong by as much: roomgraph calibrate"};
}

std::string namesOf(bool wheels, bool other_too, MotionSensor other) {
  const std::string name = toString(other);
  return wheels ? other_too ? "wheels and " + name : "wheels" : name;
}

// The way of a sensor that is turned against all others; of two, the one that is not the wheels, which say what is straight on.
void addTurned(const MovementAgreement& agreement, std::vector<Finding>& out) {
  for (const MotionSensor sensor : {MotionSensor::kCamera, MotionSensor::kLidar}) {
    const MotionSensor other = sensor == MotionSensor::kCamera ? MotionSensor::kLidar : MotionSensor::kCamera;
    const auto by_other = agreement.turned(sensor, other), by_wheels = agreement.turned(sensor, MotionSensor::kWheels);
    if (by_wheels ? isTurned(by_wheels) && (!by_other || isTurned(by_other)) : sensor == MotionSensor::kCamera && isTurned(by_other))
      out.push_back(turnedFinding(sensor, by_wheels ? *by_wheels : *by_other, namesOf(by_wheels.has_value(), by_other.has_value(), other)));
  }
}

}  // namespace

std::vector<Finding> movementFindings(const MovementAgreement& agreement, double start_t) {
  std::vector<Finding> out;
  addTurned(agreement, out);
  for (const MotionSensor sensor : kMotionSensors)
    if (auto found = contradictionsOf(sensor, agreement.contradictions(), start_t)) out.push_back(std::move(*found));
  std::stable_sort(out.begin(), out.end(), [](const Finding& a, const Finding& b) { return a.severity > b.severity; });
  return out;
}

}  // namespace roomgraph
