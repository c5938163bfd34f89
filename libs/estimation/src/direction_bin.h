// SPDX-License-Identifier: BSD-3-Clause
// Directions of view in steps.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace roomgraph {

/// Number of the step of `angle_rad` that the direction of a horizontal ray lies in; negative to the right of the x axis.
inline int directionBin(const Eigen::Vector2d& ray, double angle_rad) {
  return static_cast<int>(std::floor(std::atan2(ray.y(), ray.x()) / angle_rad));
}

}  // namespace roomgraph
