// SPDX-License-Identifier: BSD-3-Clause
// L-shape fit of rectangles to footprint points.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "roomgraph/proposals/box_evidence.h"

namespace roomgraph {

/// Rectangle around footprint points: centre, yaw of its first side in [0, pi/2), full sizes along both axes.
struct FootprintRectangle {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  double yaw = 0, size_first = 0, size_second = 0;
};

/// Rectangles with many points near their two visible sides (closeness criterion of L-shape fitting, over sampled yaw):
/// local maxima of the criterion, best first, at most `max_count`. `faces`: directions of the object's vertical faces, if
/// any are known; along them the criterion counts more. Extents are the 2 % and 98 % quantiles.
std::vector<FootprintRectangle> fitRectangles(const std::vector<Eigen::Vector2d>& points,
                                              const VerticalFaces& faces = {}, int max_count = 2);

}  // namespace roomgraph
