// SPDX-License-Identifier: BSD-3-Clause
// Parsing and range checks of camera, lidar, odometry and detector entries.
#include "sensor_entries.h"

#include "roomgraph/geometry/degree.h"

namespace roomgraph {
namespace {

Eigen::Vector3d place(JsonEntry& entry, const Eigen::Vector3d& fallback) {
  if (!entry.has("at_m")) return fallback;
  const auto at = entry.numbers("at_m", 3);
  if (at[2] < 0 || at[2] > 3) entry.fail("at_m", "the height must be in [0, 3] m");
  return {at[0], at[1], at[2]};
}

CameraSpec camera(JsonEntry entry, bool robot) {
  CameraSpec out;
  entry.choice("preset", "kinect", {"kinect"});
  out.rate_hz = entry.number("rate_hz", out.rate_hz, 0.1, 60);
  if (robot) {
    out.at_m = place(entry, out.at_m);
    out.pitch_down_rad = kDegree * entry.number("pitch_down_deg", out.pitch_down_rad / kDegree, -89, 89);
  }
  out.model.width = entry.integer("width_px", out.model.width, 32, 4096);
  out.model.height = entry.integer("height_px", out.model.height, 32, 4096);
  const double scale = out.model.width / 640.0;
  out.model.fx = out.model.fy = entry.number("focal_px", 525 * scale, 10, 1e5);
  out.model.cx = (out.model.width - 1) / 2.0;
  out.model.cy = (out.model.height - 1) / 2.0;
  out.focal_px = 580 * scale;
  out.near_m = entry.number("near_m", out.near_m, 0.05, 10);
  out.far_m = entry.number("far_m", out.far_m, 0.1, 60);
  if (out.far_m <= out.near_m) entry.fail("far_m", "must be greater than near_m");
  out.noise_gain = entry.number("noise", out.noise_gain, 0, 10);
  out.jpeg_quality = entry.integer("jpeg_quality", out.jpeg_quality, 10, 100);
  entry.finish();
  return out;
}

LidarSpec lidar(JsonEntry entry) {
  LidarSpec out;
  entry.choice("preset", "rplidar", {"rplidar"});
  out.rate_hz = entry.number("rate_hz", out.rate_hz, 0.1, 100);
  out.beams = entry.integer("beams", out.beams, 8, 10000);
  out.at_m = place(entry, out.at_m);
  out.min_m = entry.number("range_min_m", out.min_m, 0, 10);
  out.max_m = entry.number("range_max_m", out.max_m, 0.1, 200);
  if (out.max_m <= out.min_m) entry.fail("range_max_m", "must be greater than range_min_m");
  out.sigma_m = entry.number("sigma_m", out.sigma_m, 0, 1);
  out.sigma_relative = entry.number("sigma_relative", out.sigma_relative, 0, 1);
  out.dropouts = entry.number("dropouts", out.dropouts, 0, 1);
  entry.finish();
  return out;
}

OdometrySpec odometry(JsonEntry entry) {
  OdometrySpec out;
  entry.choice("preset", "kobuki", {"kobuki"});
  out.rate_hz = entry.number("rate_hz", out.rate_hz, 0.1, 200);
  const double gain = entry.number("noise", 1, 0, 10);
  out.scale_error = gain * entry.number("scale_error", out.scale_error, -0.5, 0.5);
  out.turn_error = gain * entry.number("turn_error", out.turn_error, -0.5, 0.5);
  out.drift_rad_m = gain * kDegree * entry.number("drift_deg_m", out.drift_rad_m / kDegree, -30, 30);
  out.sigma_length = gain * entry.number("sigma_length", out.sigma_length, 0, 1);
  out.sigma_turn = gain * entry.number("sigma_turn", out.sigma_turn, 0, 1);
  out.slips = entry.integer("slips", out.slips, 0, 1000);
  out.slip_m = gain * entry.number("slip_m", out.slip_m, 0, 5);
  out.slip_rad = gain * kDegree * entry.number("slip_deg", out.slip_rad / kDegree, 0, 180);
  entry.finish();
  return out;
}

DetectionsSpec detections(JsonEntry entry) {
  DetectionsSpec out;
  out.persistent = entry.choice("errors", "independent", {"independent", "persistent"}) == "persistent";
  out.detect_probability = entry.number("detect_probability", out.detect_probability, 0, 1);
  out.min_visible = entry.number("min_visible", out.min_visible, 0, 1);
  out.min_height_px = entry.number("min_height_px", out.min_height_px, 1, 4096);
  out.jitter = entry.number("jitter", out.jitter, 0, 1);
  out.false_positives = entry.number("false_positives", out.false_positives, 0, 20);
  // A key of the other kind of errors is an unknown one: it would have no effect.
  if (out.persistent) {
    out.mislead = entry.number("mislead", out.mislead, 0, 4);
    out.duplicates = entry.number("duplicates", out.duplicates, 0, 1);
    out.memory_s = entry.number("memory_s", out.memory_s, 0, 60);
  } else {
    out.confusion = entry.number("confusion", out.confusion, 0, 1);
  }
  entry.finish();
  return out;
}

}  // namespace

void readSensors(JsonEntry entry, World& world) {
  const bool robot = world.robot.has_value();
  if (entry.has("camera")) world.camera = camera(entry.child("camera"), robot);
  for (const std::string wheeled : {"lidar", "odometry"})
    if (!robot && entry.has(wheeled)) entry.fail(wheeled, "a hand-held camera has none");
  if (entry.has("lidar")) world.lidar = lidar(entry.child("lidar"));
  if (entry.has("odometry")) world.odometry = odometry(entry.child("odometry"));
  if (entry.has("detections")) {
    if (!world.camera) entry.fail("detections", "need a camera");
    world.detections = detections(entry.child("detections"));
  }
  if (!world.camera && !world.lidar && !world.odometry) entry.fail("", "at least one sensor must be given");
  entry.finish();
}

}  // namespace roomgraph
