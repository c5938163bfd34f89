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

Finding turnedFinding(const std::string& place, const char* pattern, const TurnedBy& by, const std::string& others, const std::string& hint) {
  char text[200];
  std::snprintf(text, sizeof text, pattern, by.rad / kDegree, by.sigma_rad / kDegree, others.c_str());
  return {Severity::kWarning, text, place, hint};
}

constexpr const char* kItsWay = "its way is turned by %.1f deg (+- %.1f) against that of %s";

// One sensor against the wheels, which say what is straight ahead: it, or they.
std::optional<Finding> turnedAgainstWheels(MotionSensor sensor, const TurnedBy& by) {
  if (!isTurned(by)) return std::nullopt;
  return turnedFinding(toString(sensor), kItsWay, by, "wheels", "the yaw of its recorded pose on the robot is wrong by as much, or the wheels do not drive along x");
}

// Of three sensors the one that is turned against both others, of two camera and lidar one or the other.
void addTurned(const MovementAgreement& agreement, std::vector<Finding>& out) {
  using enum MotionSensor;
  const auto camera_lidar = agreement.turned(kCamera, kLidar), camera_wheels = agreement.turned(kCamera, kWheels), lidar_wheels = agreement.turned(kLidar, kWheels);
  if (camera_lidar && camera_wheels && lidar_wheels) {
    const std::string hint = "the yaw of its recorded pose on the robot is wrong by as much: roomgraph calibrate";
    if (!isTurned(camera_lidar)) return;
    if (isTurned(camera_wheels)) out.push_back(turnedFinding("camera", kItsWay, *camera_wheels, "wheels and lidar", hint));
    if (isTurned(lidar_wheels)) out.push_back(turnedFinding("lidar", kItsWay, *lidar_wheels, "wheels and camera", hint));
    return;
  }
  if (isTurned(camera_lidar))
    out.push_back(turnedFinding("camera and lidar", "their ways are turned by %.1f deg (+- %.1f) against each other%s", *camera_lidar, "",
                                "the yaw of the recorded pose of one of them on the robot is wrong by as much"));
  if (camera_wheels)
    if (auto found = turnedAgainstWheels(kCamera, *camera_wheels)) out.push_back(std::move(*found));
  if (lidar_wheels)
    if (auto found = turnedAgainstWheels(kLidar, *lidar_wheels)) out.push_back(std::move(*found));
}

}  // namespace

std::vector<Finding> movementFindings(const MovementAgreement& agreement, double start_t) {
  std::vector<Finding> out;
  addTurned(agreement, out);
  for (const MotionSensor sensor : kMotionSensors)
    if (auto found = contradictionsOf(sensor, agreement.contradictions(), start_t)) out.push_back(std::move(*found));
  return out;
}

}  // namespace roomgraph
