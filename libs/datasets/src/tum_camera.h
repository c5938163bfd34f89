// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#pragma once

#include "roomgraph/datasets/tum_import.h"

namespace roomgraph {

struct TumCamera {
  PinholeCamera camera;  ///< fy is positive; width and height are 0 when unknown
  double depth_scale = 0;
  bool mirrored = false;  ///< fy was given negative
};

/// Intrinsics from the camera file and the options. Throws ConfigError when something is not given anywhere,
/// InputError when the file is broken.
TumCamera readTumCamera(const std::filesystem::path& folder, const TumImportOptions& options);

}  // namespace roomgraph
