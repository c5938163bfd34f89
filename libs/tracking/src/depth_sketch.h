// SPDX-License-Identifier: BSD-3-Clause
// DepthSketch: a coarse depth image, kept to see whether two views can be of one place.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "roomgraph/geometry/box.h"
#include "roomgraph/observations/frame.h"

namespace roomgraph::tracking {

struct DepthSketch {
  PinholeCamera camera;  ///< of the coarse image
  cv::Mat depth_mm;      ///< CV_16UC1; 0: not measured, too far to say much, or left out
};

/// `excluded`: regions of the frame that are left out, px: what moves may be elsewhere in another view.
DepthSketch sketchDepth(const Frame& frame, const std::vector<Box2>& excluded);

/// A view beside others: its camera in their common frame.
struct PlacedSketch {
  const DepthSketch* sketch;
  Pose3 place_from_camera = Pose3::Identity();
};

/// Whether two places can be one: of the surfaces that two views of them should both see, nearly all must not
/// be where the other sees through, [0, 1]; the least share over all pairs of views. Walls that only look
/// alike stand in each other's free space, if not here, then round the corner. 1 where nothing is seen by
/// both.
double agreement(const std::vector<PlacedSketch>& a, const std::vector<PlacedSketch>& b,
                 const Pose3& a_from_b);

}  // namespace roomgraph::tracking
