// SPDX-License-Identifier: BSD-3-Clause
// Reader options from those of the run with its calibration, and --pose as an override of [pipeline] sensor_poses.
#include "roomgraph/pipeline/read_options.h"

namespace roomgraph {

ReadOptions readOptionsOf(const Options& options) {
  const auto& poses = options.general.sensor_poses;
  Calibration calibration;
  if (!options.general.calibration_file.empty())
    calibration = readCalibration(options.general.calibration_file);
  for (const auto& [label, pose] : parseSensorPoses(poses, "[pipeline] sensor_poses = '" + poses + "'"))
    calibration.poses.insert_or_assign(label, pose);
  return {.frames = options.tracking.enabled || options.detection.enabled,
          .scans = options.lidar.enabled,
          .odometry = options.odometry.enabled,
          .rgbd_label = options.rgbd.label,
          .lidar_label = options.lidar.label,
          .odometry_label = options.odometry.label,
          .sensor_poses = calibration.poses,
          .corrections = calibration.corrections,
          .continue_time = options.general.set_clocks};
}

ReadOptions readOptionsOf(const Options& options, const Config& config) {
  ReadOptions out = readOptionsOf(options);
  out.continue_time = out.continue_time && config.text("detection", "file", "").empty();
  return out;
}

void placeSensor(Config& config, const std::string& assignment) {
  parseSensorPoses(assignment, "--pose " + assignment);
  const std::string before = config.text("pipeline", "sensor_poses", "");
  const std::string poses = before + (before.empty() ? "" : ",") + assignment;
  config.override("pipeline.sensor_poses=" + formatParameter(poses));
}

void useCalibration(Config& config, const std::string& file) {
  config.override("pipeline.calibration_file=" + formatParameter(file));
}

}  // namespace roomgraph
