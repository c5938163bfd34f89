// SPDX-License-Identifier: BSD-3-Clause
// Motion of a box between frames from point pairs or from camera movement and depth.
#pragma once

#include <opencv2/core/types.hpp>
#include <optional>
#include <vector>

#include "roomgraph/geometry/box.h"
#include "roomgraph/geometry/camera.h"
#include "roomgraph/geometry/pose.h"
#include "roomgraph/observations/frame.h"

namespace roomgraph {

/// now = scale * then + shift, px.
struct BoxMotion {
  double scale = 1, shift_u = 0, shift_v = 0;
  std::vector<std::size_t> inliers;  ///< indices of the pairs that agree
  Box2 apply(const Box2& box) const;
};

/// Scale and shift of point pairs by medians, robust as long as fewer than half of the pairs are outliers. Nothing with
/// fewer than four inliers, which agree to 2 % of `size_px`, the diagonal of the box, or to 2 px.
std::optional<BoxMotion> fitMotion(const std::vector<cv::Point2f>& then, const std::vector<cv::Point2f>& now,
                                   double size_px);

/// Depth of the object in a box, m: the lower third quantile of the valid pixels in its middle. 0: none is valid.
double objectDepth(const Box2& box, const Frame& frame);

struct PlacedBox {
  Box2 box;
  double depth_m = 0;
};
/// Predicted box of an object at rest after a movement of the camera; nothing when it is then behind the camera.
std::optional<PlacedBox> carriedByCamera(const Box2& box, double depth_m, const PinholeCamera& camera,
                                         const Pose3& current_from_previous);

/// `box` with those sides kept on (or beyond) the image's border that were there in `before`: how far a cut object
/// extends beyond the border is unknown.
Box2 stayingCut(const Box2& box, const Box2& before, int width, int height);

}  // namespace roomgraph
