// SPDX-License-Identifier: BSD-3-Clause
// Reader options from the stages, and --pose as an override of [pipeline] sensor_poses.
#include "roomgraph/pipeline/read_options.h"

namespace roomgraph {

ReadOptions readOptionsOf(const Stages& stages) {
  const auto& poses = stages.general.sensor_poses;
  return {.frames = stages.tracking.enabled || stages.detection.enabled,
          .scans = stages.lidar.enabled,
          .odometry = stages.odometry.enabled,
          .rgbd_label = stages.rgbd.label,
          .lidar_label = stages.lidar.label,
          .odometry_label = stages.odometry.label,
          .sensor_poses = parseSensorPoses(poses, "[pipeline] sensor_poses = '" + poses + "'")};
}

void placeSensor(Config& config, const std::string& assignment) {
  parseSensorPoses(assignment, "--pose " + assignment);
  const std::string before = config.text("pipeline", "sensor_poses", "");
  const std::string poses = before + (before.empty() ? "" : ",") + assignment;
  config.override("pipeline.sensor_poses=" + formatParameter(poses));
}

}  // namespace roomgraph
