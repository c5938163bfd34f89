// SPDX-License-Identifier: BSD-3-Clause
// Distortions of lenses that PinholeCamera has no coefficients for, removed from the images.
#pragma once

#include <mrpt/img/TCamera.h>

#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "roomgraph/geometry/camera.h"

namespace roomgraph {

/// A fisheye lens (Kannala and Brandt 2006, four coefficients), or OpenCV's k1 k2 p1 p2 k3 and, of a rational one, k4 k5 k6.
struct Lens {
  bool fisheye = false;
  std::vector<double> coefficients;
};

/// The lens of a camera when five coefficients of plumb_bob do not say all of it.
std::optional<Lens> otherLensOf(const mrpt::img::TCamera& camera);

/// The image as a pinhole camera of the same intrinsics sees it; black, or 0, where the lens saw nothing.
cv::Mat withoutLens(const cv::Mat& image, const PinholeCamera& camera, const Lens& lens, int interpolation);

}  // namespace roomgraph
