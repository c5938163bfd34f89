// SPDX-License-Identifier: BSD-3-Clause
// Image edges in and around a detection's box.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "roomgraph/observations/proposal.h"

namespace roomgraph {

/// Image edges in and around a box (method.md sec. 1.4).
struct BoxEdges {
  std::vector<Segment2> segments;  ///< straight parts (Hough), px of the whole image, longest first
  cv::Mat pixels;                  ///< CV_8UC1, Canny edges of the reduced image
  cv::Mat distance;  ///< CV_32FC1, px of the reduced image: to the nearest edge pixel; empty where depth is known
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< px; the reduced image's corner in the whole one
  double scale = 1;                                  ///< reduced px per px

  /// Distance to the nearest edge pixel, px. Outside the box: that of the nearest pixel in it, plus the distance to it.
  double distanceAt(const Eigen::Vector2d& pixel) const;
};

}  // namespace roomgraph
