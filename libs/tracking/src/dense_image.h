// SPDX-License-Identifier: BSD-3-Clause
// DenseImage: brightness, depth and normals of a frame at two coarse resolutions.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "roomgraph/geometry/box.h"
#include "roomgraph/observations/frame.h"

namespace roomgraph::tracking {

/// Depth image of a camera that sees the same with fewer pixels (CV_32FC1, m). 0: not measured, farther, or left out. It is
/// not averaged: between an object and what is behind it there is nothing.
cv::Mat coarseDepth(const Frame& frame, const std::vector<Box2>& excluded, const PinholeCamera& camera, float farthest_m);

/// One resolution of a DenseImage.
struct DenseLevel {
  PinholeCamera camera;
  cv::Mat brightness;            ///< CV_32FC1, grey levels [0, 255]
  cv::Mat slope_x, slope_y;      ///< CV_32FC1, its derivatives, grey levels per px
  cv::Mat depth;                 ///< CV_32FC1, m; 0: not measured, or left out
  cv::Mat normals;               ///< CV_32FC3, towards the camera; 0: none
  cv::Mat normal_variance;       ///< CV_32FC1, of a normal's angle, by the depths around it, rad^2
};

/// What dense alignment needs of a frame; levels from fine to coarse.
class DenseImage {
 public:
  /// `excluded`: regions of the frame that are left out, px.
  DenseImage(const Frame& frame, const std::vector<Box2>& excluded);
  const std::vector<DenseLevel>& levels() const { return levels_; }

 private:
  std::vector<DenseLevel> levels_;
};

}  // namespace roomgraph::tracking
