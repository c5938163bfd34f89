// SPDX-License-Identifier: BSD-3-Clause
// KeyView: an image of a map, reduced to what finds its place again.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// A corner of an image: its ORB descriptor, and where it is in the camera's optical frame, mm (38 bytes in a
/// file).
struct KeyCorner {
  std::array<std::uint8_t, 32> descriptor{};
  std::array<std::int16_t, 3> place_mm{};
};

/// An image reduced to corners with depth, and the pose of its camera.
struct KeyView {
  double t = 0;                                 ///< s
  Pose3 world_from_camera = Pose3::Identity();  ///< optical frame
  std::vector<KeyCorner> corners;
};

}  // namespace roomgraph
