// SPDX-License-Identifier: BSD-3-Clause
// Export of a rawlog's RGB-D records as a folder in TUM format.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "roomgraph/geometry/camera.h"
#include "roomgraph/geometry/pose.h"

namespace roomgraph {

struct TumExportResult {
  std::string label;     ///< sensor whose records were written
  int written = 0;       ///< image pairs
  int left_out = 0;      ///< RGB-D records of other sensors, or without one of the two images
  int registered = 0;    ///< pairs whose depth was projected into the colour camera, colour undistorted
  PinholeCamera camera;  ///< of both images
  Pose3 robot_from_camera = Pose3::Identity();  ///< x forward; the folder has no place for it
  bool ground_truth = false;
  std::vector<std::string> warnings;
};

/// Writes rgb/ and depth/ (PNG, without loss), rgb.txt, depth.txt, associations.txt, camera.json, and
/// groundtruth.txt when X.groundtruth.txt stands beside the rawlog (in poses of the camera, as the format has them): what importTum()
/// reads back to the same records. `label`: of the camera; empty: the first that appears. Depth registered to colour is written as
/// it is, with depth_scale = 1 / rangeUnits; other depth is projected into the colour camera first and
/// written with 5000. The folder gets its name when it is whole. `progress` gets the share done and may throw
/// to end the export.
///
/// Throws InputError (no rawlog, no image pair in it), ConfigError (no such label, the folder is there and
/// not empty) or RunError (cannot be written).
TumExportResult exportTum(const std::filesystem::path& rawlog, const std::filesystem::path& folder,
                          const std::string& label = "",
                          const std::function<void(double share)>& progress = nullptr);

}  // namespace roomgraph
