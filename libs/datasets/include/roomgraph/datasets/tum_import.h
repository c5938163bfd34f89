// SPDX-License-Identifier: BSD-3-Clause
// Import of a TUM or ICL-NUIM folder as a rawlog of RGB-D records.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "roomgraph/geometry/camera.h"
#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// Intrinsics and depth scale come from the single options, else from the preset or the camera file.
struct TumImportOptions {
  std::string preset{};  ///< of camera_presets.h, instead of a camera file
  std::optional<std::filesystem::path>
      camera_file{};                             ///< default: camera.json in the folder, if there is one
  std::optional<double> fx{}, fy{}, cx{}, cy{};  ///< px; replace what the camera file says
  std::optional<double> depth_scale{};           ///< depth PNG value / depth_scale = metres
  double max_time_difference_s = 0.02;           ///< between colour and depth, for rgb.txt + depth.txt
  std::optional<double> frame_rate_hz{};         ///< stamps are frame numbers (ICL-NUIM) at this rate
  bool external_images = false;                  ///< images in X_Images/ beside the rawlog
  std::string label = "RGBD";                    ///< sensorLabel of the records
  Pose3 robot_from_sensor = Pose3::Identity();   ///< x forward; identity: handheld
};

struct TumImportResult {
  PinholeCamera camera;
  int written = 0;                     ///< records
  int missing = 0;                     ///< pairs left out: a file is missing or unreadable
  bool mirrored = false;               ///< fy < 0: see importTum()
  std::filesystem::path ground_truth;  ///< file written; empty when the folder has none
  std::vector<std::string> warnings;
};

/// Writes a TUM / ICL-NUIM folder as an observation-only rawlog (gz) of CObservation3DRangeScan, one for each
/// pair in associations.txt (columns in either order) or, without that file, of rgb.txt and depth.txt paired
/// by time. Depth values are kept as they are, with rangeUnits = 1 / depth_scale. Ground truth (camera poses)
/// is written beside it as X.groundtruth.txt. Rawlog and external images get into place together, at the end;
/// what a former import to the same place left beside it and this one does not have is removed.
///
/// ICL-NUIM gives fy < 0: its camera frame has y up and is left-handed, though its images are upright. The
/// images are left as they are and |fy| is used, which puts the same ray through every pixel with y down;
/// poses T of the ground truth become S T S with S = diag(1, -1, 1): the world is mirrored to be
/// right-handed.
///
/// Throws ConfigError (no intrinsics or depth scale, unknown preset, a place to write that is read, an
/// X_Images that no import made), InputError (folder or lists unusable, no pair left) or RunError (output
/// cannot be written).
TumImportResult importTum(const std::filesystem::path& folder, const std::filesystem::path& rawlog,
                          const TumImportOptions& options = {},
                          const std::function<void(std::size_t done, std::size_t total)>& progress = nullptr);

}  // namespace roomgraph
