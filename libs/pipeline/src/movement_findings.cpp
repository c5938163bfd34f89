// SPDX-License-Identifier: BSD-3-Clause
// Words for contradictions and turned sensors.
#include "movement_findings.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

#include "roomgraph/geometry/degree.h"
#include "roomgraph/pipeline/mount_settings.h"

namespace roomgraph {
namespace {

constexpr double kLong_s = 2;  // a contradiction that lasts spoils more than its moment

const char* causeOf(MotionSensor sensor) {
  switch (sensor) {
    case MotionSensor::kWheels: return "wheels slip or are lifted, or the robot is pushed";
    case MotionSensor::kCamera: return "pictures full of what moves or repeats mislead";
    case MotionSensor::kLidar: return "scans full of what moves, or along bare corridors, mislead";
  }
  return "";
}

// Of one sensor with both others, or with the only other one.
std::optional<Finding> contradictionsOf(MotionSensor sensor, std::optional<MotionSensor> only_other, const std::vector<Contradiction>& all) {
  double seconds = 0, longest_s = 0, off_m = 0, off_rad = 0, first_t = 0;
  int times = 0;
  for (const Contradiction& one : all) {
    if (one.sensor != sensor || one.only_other != only_other) continue;
    if (times++ == 0) first_t = one.from_t;
    seconds += one.until_t - one.from_t;
    longest_s = std::max(longest_s, one.until_t - one.from_t);
    off_m = std::max(off_m, one.off_m);
    off_rad = std::max(off_rad, one.off_rad);
  }
  if (times == 0) return std::nullopt;
  char text[200];
  const std::string how_often = times > 1 ? " " + std::to_string(times) + " times," : "";
  std::snprintf(text, sizeof text, "%s%s for %.1f s, first from t = %.3f s on, by up to %.2f m and %.1f deg",
                only_other ? "contradict each other" : "contradicts both other sensors", how_often.c_str(), seconds, first_t, off_m,
                off_rad / kDegree);
  // Two that differ now and then have nobody who says that one of them is right.
  const Severity severity = (only_other ? longest_s : seconds) >= kLong_s ? Severity::kWarning : Severity::kNote;
  if (only_other)
    return Finding{severity, text, std::string(toString(sensor)) + " and " + toString(*only_other),
                   std::string("one of them is wrong: ") + causeOf(sensor) + ", or " + causeOf(*only_other)};
  return Finding{severity, text, toString(sensor), std::string(causeOf(sensor)) + ": what they measure counts less there"};
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

std::vector<Finding> movementFindings(const MovementAgreement& agreement) {
  std::vector<Finding> out;
  addTurned(agreement, out);
  for (std::size_t i = 0; i < kMotionSensors.size(); ++i) {
    const MotionSensor sensor = kMotionSensors[i], next = kMotionSensors[(i + 1) % kMotionSensors.size()];
    if (auto found = contradictionsOf(sensor, std::nullopt, agreement.contradictions())) out.push_back(std::move(*found));
    if (auto found = contradictionsOf(sensor, next, agreement.contradictions())) out.push_back(std::move(*found));
  }
  return out;
}

}  // namespace roomgraph
