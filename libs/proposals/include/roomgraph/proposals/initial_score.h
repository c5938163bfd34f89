// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#pragma once

#include <string>

#include "roomgraph/observations/detection.h"
#include "roomgraph/observations/frame.h"

namespace roomgraph {

/// Initialisation score of a detection (method.md sec. 1.5) and its three parts, all in [0, 1].
struct InitialScore {
  double value = 0, area = 0, edges = 0, depth = 0;
  std::string text() const;
};

/// `valid_depth_ratio` comes from the depth mask. The edge part is the length of Canny / Hough segments in
/// the box over its perimeter; 0 without an image.
InitialScore initialScore(const Frame& frame, const Detection& detection, double valid_depth_ratio);

}  // namespace roomgraph
