// SPDX-License-Identifier: BSD-3-Clause
// Intrinsic matrix and intrinsics of a resized image.
#include "roomgraph/geometry/camera.h"

#include <cmath>

namespace roomgraph {

Eigen::Matrix3d PinholeCamera::matrix() const {
  return (Eigen::Matrix3d() << fx, 0, cx, 0, fy, cy, 0, 0, 1).finished();
}

PinholeCamera PinholeCamera::scaled(double factor) const {
  PinholeCamera out = *this;
  out.width = static_cast<int>(std::lround(width * factor));
  out.height = static_cast<int>(std::lround(height * factor));
  out.fx *= factor;
  out.fy *= factor;
  // Pixel centres have integer coordinates, so the image's corner (-0.5, -0.5) is the fixed point.
  out.cx = (cx + 0.5) * factor - 0.5;
  out.cy = (cy + 0.5) * factor - 0.5;
  return out;
}

}  // namespace roomgraph
