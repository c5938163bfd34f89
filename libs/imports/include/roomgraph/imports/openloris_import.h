// SPDX-License-Identifier: BSD-3-Clause
// Import of sequences of OpenLORIS-Scene as rawlogs.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "roomgraph/datasets/sensor_poses.h"
#include "roomgraph/geometry/camera.h"

namespace roomgraph {

struct OpenlorisImportOptions {
  double max_time_difference_s = 0.02;  ///< between colour and depth
  std::optional<PinholeCamera> camera;  ///< instead of sensors.yaml; size 0: that of the images
  SensorPoses sensor_poses;             ///< robot_from_sensor by label, instead of trans_matrix.yaml
  std::optional<int> jpeg_quality;      ///< of colour in the rawlog; nothing: without loss
  bool external_images = false;         ///< images in X_Images/
};

struct OpenlorisImportResult {
  std::map<std::string, int> written;  ///< records by label
  std::map<std::string, int> skipped;  ///< by reason
  std::filesystem::path ground_truth;  ///< file written; empty when the folder has none
  std::vector<std::string> warnings;
};

/// Writes the folder of a sequence as an observation-only rawlog in order of time:
/// CObservation3DRangeScan, label D400, of color.txt and aligned_depth.txt, paired by time (depth in mm,
/// registered to colour); CObservationOdometry, label ODOMETRY, of odom.txt (t x y z qx qy qz qw vx vy vz wx
/// wy wz). The camera is d400_color_optical_frame of sensors.yaml (OpenCV's YAML; intrinsics fx cx fy cy),
/// its place in base_link that of the chain of trans_matrix.yaml. groundtruth.txt, poses of the robot, goes
/// to X.groundtruth.txt.
///
/// What is missing or broken is left out, counted and told. Throws InputError (no such folder, nothing usable
/// in it), ConfigError (no such label, a place to write that is read) or RunError (output cannot be written).
OpenlorisImportResult importOpenloris(const std::filesystem::path& folder,
                                      const std::filesystem::path& rawlog,
                                      const OpenlorisImportOptions& options = {},
                                      const std::function<void(double share)>& progress = nullptr);

}  // namespace roomgraph
