// SPDX-License-Identifier: BSD-3-Clause
// Published calibrations of well-known RGB-D cameras and data sets.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roomgraph/geometry/camera.h"

namespace roomgraph {

/// Published calibration of a well-known camera or data set. docs/formats.md has the table with the sources.
struct CameraPreset {
  std::string name;
  PinholeCamera camera;     ///< fy < 0 where it was published so (ICL-NUIM)
  double depth_scale = 0;   ///< value in the depth image / depth_scale = metres
  int invalid_depth = 0;    ///< value besides 0 that stands for "no measurement"; 0: none
  std::string folder_hint;  ///< part of the names of the data set's folders; empty: they have no pattern
};

const std::vector<CameraPreset>& cameraPresets();
/// The one of that name; nothing when there is none.
std::optional<CameraPreset> findCameraPreset(const std::string& name);
/// Name of the preset that a folder's name speaks for ("rgbd_dataset_freiburg1_desk": freiburg1); empty when
/// none.
std::string presetForFolder(const std::string& folder_name);
/// "freiburg1|freiburg2|…".
std::string presetNames();

}  // namespace roomgraph
