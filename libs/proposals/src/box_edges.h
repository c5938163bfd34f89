// SPDX-License-Identifier: BSD-3-Clause
// Canny edges and Hough segments in a detection's box, with distance transform.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "depth_mask.h"
#include "roomgraph/observations/frame.h"
#include "roomgraph/observations/proposal.h"

namespace roomgraph {

/// Image edges in and around a box (method.md sec. 1.4).
struct BoxEdges {
  std::vector<Segment2> segments;  ///< straight parts (Hough), px of the whole image, longest first
  cv::Mat pixels;                  ///< CV_8UC1, Canny edges of the reduced image
  cv::Mat distance;  ///< CV_32FC1: to the nearest edge pixel, px of the reduced image; see addDistances
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< px; the reduced image's corner in the whole one
  double scale = 1;                                  ///< reduced px per px

  /// Distance to the nearest edge pixel, px; far outside the box the largest there is.
  double distanceAt(const Eigen::Vector2d& pixel) const;
};

/// Canny edges and Hough segments of the box with a small rim; empty without an image.
BoxEdges findEdges(const Frame& frame, const Box2& box);

/// Fills in `distance` where there are edges: only scoring without depth needs it.
void addDistances(BoxEdges& edges);

double totalLength(const std::vector<Segment2>& segments);

/// Only the segments whose middle lies on the mask or at its rim; all of them when the mask is empty.
std::vector<Segment2> supportedSegments(const std::vector<Segment2>& segments, const DepthMask& mask,
                                        const Box2& box);

}  // namespace roomgraph
