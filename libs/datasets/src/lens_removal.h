// SPDX-License-Identifier: BSD-3-Clause
// Distortions of lenses, removed from the images.
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>

#include "roomgraph/observations/mrpt_camera.h"

namespace roomgraph {

/// The lens of a camera when five coefficients of plumb_bob, those of a PinholeCamera, do not say all of it.
std::optional<Distortion> otherLensOf(const mrpt::img::TCamera& camera);

/// The image as a pinhole camera of the same intrinsics sees it; black, or 0, where the lens saw nothing.
cv::Mat withoutLens(const cv::Mat& image, const PinholeCamera& camera, const Distortion& lens, int interpolation);

}  // namespace roomgraph
