// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph info`: sensors, cameras, depth and scans of a rawlog as text or JSON.
#include <mrpt/math/TPose3D.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "roomgraph/core/output_file.h"
#include "roomgraph/core/progress.h"
#include "roomgraph/datasets/rawlog_report.h"
#include "roomgraph/geometry/degree.h"

namespace roomgraph {
namespace {

using nlohmann::ordered_json;

template <class... Values>
void print(const char* pattern, Values... values) {
  char text[600];
  std::snprintf(text, sizeof text, pattern, values...);
  std::cout << text;
}

mrpt::math::TPose3D yawPitchRoll(const Pose3& pose) {
  return toMrpt(pose).asTPose();
}

void printCamera(const char* name, int width, int height, const PinholeCamera& camera, const Distortion& lens) {
  if (width == 0) return;
  print("    %-9s %dx%d px, fx %.2f fy %.2f cx %.2f cy %.2f", name, width, height, camera.fx, camera.fy,
        camera.cx, camera.cy);
  const auto& values = lens.coefficients;
  if (std::any_of(values.begin(), values.end(), [](double value) { return value != 0; })) {
    std::cout << ", distortion (" << lens.model << ")";
    for (const double value : values) print(" %.4g", value);
  }
  std::cout << "\n";
}

void printImages(const ImageSummary& images) {
  printCamera("colour", images.color_width, images.color_height, images.color_camera, images.color_distortion);
  printCamera("depth", images.depth_width, images.depth_height, images.depth_camera, images.depth_distortion);
  if (images.depth > 0)
    print(
        "    depth     unit %.6g m, %s, %s, median %.2f m (90 %% in %.2f to %.2f m), %.0f %% of the pixels "
        "valid\n",
        images.depth_unit_m, images.range_is_depth ? "along the optical axis" : "along the ray",
        images.registered ? "registered to colour" : "not registered to colour", images.median_depth_m,
        images.near_depth_m, images.far_depth_m, 100 * images.valid_depth_share);
  if (images.floor)
    print("    floor     %.2f m below the sensor, tilted by %.1f deg against its pose (%d images)\n",
          images.floor->sensor_height_m, images.floor->tilt_rad * kDegreesPerRadian, images.floor->images);
  if (images.range_over_lidar)
    print("    lidar     depth images see %.2f times as far along horizontal rays\n",
          *images.range_over_lidar);
  if (images.external_present + images.external_missing > 0)
    print("    files     %d records with images outside the rawlog, %d missing\n",
          images.external_present + images.external_missing, images.external_missing);
}

void printScans(const ScanSummary& scans) {
  print("    scan      %d beams over %.2f deg (%s), max. range %.2f m, %.0f %% returns\n", scans.beams,
        scans.aperture_rad * kDegreesPerRadian, scans.right_to_left ? "counter-clockwise" : "clockwise",
        scans.max_range_m, 100 * scans.valid_share);
}

void printSensor(const SensorReport& sensor) {
  print("  %s  %s%s\n", sensor.label.empty() ? "(no label)" : sensor.label.c_str(), sensor.class_name.c_str(),
        sensor.used ? "" : "  (not used)");
  print("    records   %d, %.2f Hz, %.2f s, largest gap %.3f s\n", sensor.count, sensor.rate_hz,
        sensor.last_time - sensor.first_time, sensor.largest_gap_s);
  if (sensor.robot_from_sensor && sensor.used) {
    const auto pose = yawPitchRoll(*sensor.robot_from_sensor);
    print("    on robot  x %.3f y %.3f z %.3f m, yaw %.1f pitch %.1f roll %.1f deg%s\n", pose.x, pose.y,
          pose.z, pose.yaw * kDegreesPerRadian, pose.pitch * kDegreesPerRadian, pose.roll * kDegreesPerRadian,
          sensor.pose_changes ? " (first record; changes)" : "");
  }
  if (sensor.images) printImages(*sensor.images);
  if (sensor.scans) printScans(*sensor.scans);
  if (sensor.odometry)
    print("    odometry  path %.2f m, turns %.0f deg\n", sensor.odometry->path_length_m,
          sensor.odometry->turn_rad * kDegreesPerRadian);
}

void printReport(const RawlogReport& report) {
  std::cout << report.file.string() << "\n";
  print("  %.1f MB, %s, %d records, %.2f s from t = %.3f s\n\nSensors\n",
        static_cast<double>(report.file_bytes) / 1e6, report.format.c_str(), report.records,
        report.duration(), report.first_time);
  for (const auto& sensor : report.sensors) printSensor(sensor);
  std::cout << "\nFindings\n";
  if (report.findings.empty()) std::cout << "  none\n";
  for (const auto& finding : report.findings) {
    std::cout << "  " << toString(finding.severity) << ": " << finding.place << ": " << finding.what;
    if (!finding.hint.empty()) std::cout << "\n      " << finding.hint;
    std::cout << "\n";
  }
}

ordered_json toJson(const PinholeCamera& camera, const Distortion& lens) {
  return {{"fx", camera.fx},
          {"fy", camera.fy},
          {"cx", camera.cx},
          {"cy", camera.cy},
          {"distortion_model", lens.model},
          {"distortion", lens.coefficients}};
}

ordered_json toJson(const ImageSummary& images) {
  ordered_json out = {{"color", images.color},
                      {"depth", images.depth},
                      {"color_size", {images.color_width, images.color_height}},
                      {"depth_size", {images.depth_width, images.depth_height}},
                      {"color_camera", toJson(images.color_camera, images.color_distortion)},
                      {"depth_camera", toJson(images.depth_camera, images.depth_distortion)},
                      {"depth_registered", images.registered},
                      {"range_is_depth", images.range_is_depth},
                      {"depth_unit_m", images.depth_unit_m},
                      {"median_depth_m", images.median_depth_m},
                      {"near_depth_m", images.near_depth_m},
                      {"far_depth_m", images.far_depth_m},
                      {"valid_depth_share", images.valid_depth_share},
                      {"looked_at", images.looked_at},
                      {"blank", images.blank.count},
                      {"noisy", images.noisy.count},
                      {"without_depth", images.without_depth.count},
                      {"same_for_s", images.same.seconds},
                      {"external_present", images.external_present},
                      {"external_missing", images.external_missing}};
  if (images.floor) {
    out["floor_below_sensor_m"] = images.floor->sensor_height_m;
    out["floor_tilt_rad"] = images.floor->tilt_rad;
  }
  if (images.walls_off_m) out["walls_off_lidar_m"] = *images.walls_off_m;
  if (images.range_over_lidar) out["range_over_lidar"] = *images.range_over_lidar;
  return out;
}

ordered_json toJson(const ScanSummary& scans) {
  ordered_json out = {{"beams", scans.beams},
                      {"aperture_rad", scans.aperture_rad},
                      {"max_range_m", scans.max_range_m},
                      {"right_to_left", scans.right_to_left},
                      {"valid_share", scans.valid_share},
                      {"at_max_share", scans.at_max_share},
                      {"not_finite", scans.not_finite},
                      {"noisy", scans.noisy.count},
                      {"same_for_s", scans.same.seconds}};
  if (scans.rotation_ratio) out["rotation_ratio"] = *scans.rotation_ratio;
  return out;
}

ordered_json toJson(const SensorReport& sensor) {
  ordered_json out = {{"label", sensor.label},
                      {"class", sensor.class_name},
                      {"used", sensor.used},
                      {"count", sensor.count},
                      {"invalid_times", sensor.invalid_times},
                      {"out_of_order", sensor.out_of_order},
                      {"repeated_stamps", sensor.repeated_stamps},
                      {"first_time", sensor.first_time},
                      {"last_time", sensor.last_time},
                      {"rate_hz", sensor.rate_hz},
                      {"largest_gap_s", sensor.largest_gap_s},
                      {"pose_changes", sensor.pose_changes}};
  if (sensor.robot_from_sensor) {
    const auto pose = yawPitchRoll(*sensor.robot_from_sensor);
    out["sensor_pose_xyz_ypr"] = {pose.x, pose.y, pose.z, pose.yaw, pose.pitch, pose.roll};
  }
  if (sensor.images) out["images"] = toJson(*sensor.images);
  if (sensor.scans) out["scans"] = toJson(*sensor.scans);
  if (sensor.odometry) out["path_length_m"] = sensor.odometry->path_length_m;
  if (sensor.odometry) out["odometry_jumps"] = sensor.odometry->jumps;
  if (sensor.clock_offset) {
    out["clock_offset_s"] = {sensor.clock_offset->first_s, sensor.clock_offset->last_s};
    out["clock_step_s"] = sensor.clock_offset->step_s;
  }
  return out;
}

void writeJson(const RawlogReport& report, const std::filesystem::path& file) {
  ordered_json out = {{"file", report.file.string()},     {"file_bytes", report.file_bytes},
                      {"format", report.format},          {"records", report.records},
                      {"first_time", report.first_time},  {"duration_s", report.duration()},
                      {"truncation", report.truncation},  {"skipped", report.skipped},
                      {"sensors", ordered_json::array()}, {"findings", ordered_json::array()}};
  for (const auto& sensor : report.sensors) out["sensors"].push_back(toJson(sensor));
  for (const auto& finding : report.findings)
    out["findings"].push_back({{"severity", toString(finding.severity)},
                               {"place", finding.place},
                               {"what", finding.what},
                               {"hint", finding.hint}});
  writeFileAtomically(file, out.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n");
}

struct InfoArguments {
  std::filesystem::path rawlog, json;
  std::vector<std::string> poses;
};

void inspect(const InfoArguments& arguments) {
  if (!arguments.json.empty()) requireOther(arguments.json, {arguments.rawlog});
  SensorPoses poses;
  for (const auto& text : arguments.poses)
    for (const auto& [label, pose] : parseSensorPoses(text, "--pose " + text))
      poses.insert_or_assign(label, pose);
  Progress line(&std::cerr, "info", "%", 100);
  const auto report = inspectRawlog(
      arguments.rawlog, [&](double share) { line.update(100 * share); }, poses);
  line.finish();
  printReport(report);
  if (!arguments.json.empty()) writeJson(report, arguments.json);
}

}  // namespace

void addInfoCommand(CLI::App& app) {
  auto* info = app.add_subcommand("info", "Say what is inside a rawlog, and what is wrong with it");
  auto arguments = std::make_shared<InfoArguments>();
  info->add_option("RAWLOG", arguments->rawlog, "recording to look at")->required();
  info->add_option("--json", arguments->json, "also write the report to this file");
  info->add_option(
      "--pose", arguments->poses,
      "place of a sensor on the robot, SENSOR=x,y,z,yaw,pitch,roll (m, deg), instead of the recorded "
      "one; may be repeated");
  info->callback([arguments] { inspect(*arguments); });
}

}  // namespace roomgraph
