// SPDX-License-Identifier: BSD-3-Clause
// Sides of a detected box that lie inside the image rather than on its border.
#pragma once

#include <array>

#include "roomgraph/geometry/box.h"
#include "roomgraph/geometry/camera.h"

namespace roomgraph {

/// Which sides (left, top, right, bottom) of a measured box lie inside the image, not on its border.
inline std::array<bool, 4> sidesInside(const Box2& box, const PinholeCamera& camera) {
  constexpr double kBorder_px = 2;  // a detector's box hardly ever ends on the very last pixel
  return {box.u_min > kBorder_px, box.v_min > kBorder_px, box.u_max < camera.width - kBorder_px,
          box.v_max < camera.height - kBorder_px};
}

}  // namespace roomgraph
