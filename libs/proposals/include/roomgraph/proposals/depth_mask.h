// SPDX-License-Identifier: BSD-3-Clause
// Depth points of one detected object.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace roomgraph {

/// A depth measurement inside a detection's box.
struct MaskPoint {
  double u = 0, v = 0;        ///< px
  Eigen::Vector3d in_ground;  ///< m, ground frame (geometry/ground.h)
};

/// Depth points that belong to a detected object (method.md sec. 1.3).
struct DepthMask {
  std::vector<MaskPoint> points;  ///< empty: no depth, or no cluster that can be the object
  double valid_ratio = 0;         ///< share of the box's (mask's) pixels that have a depth
};

}  // namespace roomgraph
