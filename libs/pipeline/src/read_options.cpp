// SPDX-License-Identifier: BSD-3-Clause
// Reader options from those of the run, and --pose as an override of [pipeline] sensor_poses.
#include "roomgraph/pipeline/read_options.h"

namespace roomgraph {

ReadOptions readOptionsOf(const Options& options) {
  const auto& poses = options.general.sensor_poses;
  return {.frames = options.tracking.enabled || options.detection.enabled,
          .scans = options.lidar.enabled,
          .odometry = options.odometry.enabled,
          .rgbd_label = options.rgbd.label,
          .lidar_label = options.lidar.label,
          .odometry_label = options.odometry.label,
          .sensor_poses = parseSensorPoses(poses, "[pipeline] sensor_poses = '" + poses + "'")};
}

void placeSensor(Config& config, const std::string& assignment) {
  parseSensorPoses(assignment, "--pose " + assignment);
  const std::string before = config.text("pipeline", "sensor_poses", "");
  const std::string poses = before + (before.empty() ? "" : ",") + assignment;
  config.override("pipeline.sensor_poses=" + formatParameter(poses));
}

}  // namespace roomgraph
