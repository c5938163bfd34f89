// SPDX-License-Identifier: BSD-3-Clause
// Camera of a TUM or ICL-NUIM folder: intrinsics and depth scale.
#pragma once

#include "roomgraph/datasets/tum_import.h"

namespace roomgraph {

struct TumCamera {
  PinholeCamera camera;  ///< fy is positive; width and height are 0 when unknown
  double depth_scale = 0;
  int invalid_depth = 0;  ///< value besides 0 that stands for "no measurement"; 0: none
  bool mirrored = false;  ///< fy was given negative
};

/// Intrinsics from the camera file or preset, and the options. Throws ConfigError naming everything that is
/// not given anywhere, InputError when the file is broken.
TumCamera readTumCamera(const std::filesystem::path& folder, const TumImportOptions& options);

}  // namespace roomgraph
