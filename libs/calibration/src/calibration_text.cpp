// SPDX-License-Identifier: BSD-3-Clause
// Calibration as INI text with standard deviations in comments.
#include <cstdio>

#include "roomgraph/calibration/calibrate.h"
#include "roomgraph/geometry/degree.h"

namespace roomgraph {
namespace {

const char* knowledgeText(Knowledge knowledge) {
  switch (knowledge) {
    case Knowledge::kFixed:
      return "";
    case Knowledge::kPartly:
      return " (only together with others)";
    case Knowledge::kUnfixed:
      return " (not fixed by this motion: as recorded)";
    default:
      return " (as recorded)";
  }
}

bool isAngle(int parameter) {
  return std::string(parameterTraits()[static_cast<std::size_t>(parameter)].unit) == "rad";
}

std::string number(double value, const char* format = "%.6g") {
  char text[48];
  std::snprintf(text, sizeof text, format, value + 0.0);
  return text;
}

// "x +-0.0012 m, …"
std::string sigmas(const CalibrationEstimate& estimate, std::initializer_list<int> parameters) {
  std::string out = "# ";
  for (const int i : parameters) {
    const auto& traits = parameterTraits()[static_cast<std::size_t>(i)];
    const Knowledge knowledge = estimate.knowledge[static_cast<std::size_t>(i)];
    const bool known = knowledge == Knowledge::kFixed || knowledge == Knowledge::kPartly;
    if (out.size() > 2) out += ", ";
    out += traits.name;
    if (known && isAngle(i)) out += " +-" + number(estimate.sigma(i) * kDegreesPerRadian, "%.2g") + " deg";
    if (known && !isAngle(i))
      out += " +-" + number(estimate.sigma(i), "%.2g") + (*traits.unit ? " " + std::string(traits.unit) : "");
    const bool moved = knowledge == Knowledge::kUnfixed && estimate.after[i] != estimate.before[i];
    out += moved ? " (not fixed by this motion but together with others)" : knowledgeText(knowledge);
  }
  return out + "\n";
}

std::string poseText(const Pose3& pose) {
  const auto p = toMrpt(pose).asTPose();
  std::string out;
  for (const double length : {p.x, p.y, p.z}) out += number(length, "%.5f") + ", ";
  for (const double angle : {p.yaw, p.pitch}) out += number(angle * kDegreesPerRadian, "%.4f") + ", ";
  return out + number(p.roll * kDegreesPerRadian, "%.4f");
}

std::string cameraText(const CalibrationReport& report) {
  const auto& [camera, estimate, calibration, frame] = report;
  std::string out = "\n[sensor " + camera.camera_label + "]\n";
  out += sigmas(estimate, {kCameraX, kCameraY, kCameraZ});
  out += sigmas(estimate, {kCameraYaw, kCameraPitch, kCameraRoll});
  out += "pose = " + poseText(calibration.poses.at(camera.camera_label)) + "\n";
  out += sigmas(estimate, {kCameraTime}) +
         "time_offset_s = " + number(calibration.corrections.time_offsets_s.at(camera.camera_label)) + "\n";
  out += "\n[depth]\n" + sigmas(estimate, {kDepthScale}) +
         "scale = " + number(calibration.corrections.depth.scale) + "\n" + sigmas(estimate, {kDepthBias}) +
         "bias_m = " + number(calibration.corrections.depth.bias_m) + "\n";
  return out;
}

}  // namespace

std::string calibrationText(const CalibrationReport& report) {
  const auto& [sensors, estimate, calibration, frame] = report;
  std::string out =
      "# Calibration by `roomgraph calibrate`, for `roomgraph run --calibration`.\n# Frame: " + frame +
      ".\n# Poses: x, y, z (m), yaw, pitch, roll (deg). +-: one standard deviation.\n";
  if (sensors.robot_from_lidar)
    out += "\n[sensor " + sensors.lidar_label + "]\n" + sigmas(estimate, {kLidarX, kLidarY, kLidarYaw}) +
           "pose = " + poseText(calibration.poses.at(sensors.lidar_label)) + "\n";
  if (sensors.robot_from_camera) out += cameraText(report);
  if (!sensors.wheels) return out;
  const auto& wheels = calibration.corrections.wheels;
  out += "\n[wheels]\n" + sigmas(estimate, {kWheelScale}) + "scale = " + number(wheels.scale) + "\n" +
         sigmas(estimate, {kTurnScale}) + "turn_scale = " + number(wheels.turn_scale) + "\n" +
         sigmas(estimate, {kHeadingDrift}) + "drift_rad_m = " + number(wheels.drift_rad_m) + "\n" +
         sigmas(estimate, {kWheelTime}) +
         "time_offset_s = " + number(calibration.corrections.wheels_time_offset_s) + "\n";
  return out;
}

}  // namespace roomgraph
