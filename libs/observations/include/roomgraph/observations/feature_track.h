// SPDX-License-Identifier: BSD-3-Clause
// Tracked image feature with its map point and depth.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace roomgraph {

/// A tracked image feature: where it is seen, and which point of the tracker's map it shows.
struct FeatureTrack {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  std::int64_t point = -1;  ///< id of the point; stays over frames
  double depth_m = 0;       ///< along the optical axis; 0: not measured
};

}  // namespace roomgraph
