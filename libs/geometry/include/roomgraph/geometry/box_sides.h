// SPDX-License-Identifier: BSD-3-Clause
// Flags for the four sides of an image box, and which sides lie inside the image rather than on its border.
#pragma once

#include <array>

#include "roomgraph/geometry/box.h"
#include "roomgraph/geometry/camera.h"

namespace roomgraph {

/// A flag for every side of an image box.
struct BoxSides {
  bool left = false, top = false, right = false, bottom = false;

  bool any() const { return left || top || right || bottom; }
  /// In the order of a box's coordinates: u_min, v_min, u_max, v_max.
  std::array<bool, 4> inOrder() const { return {left, top, right, bottom}; }
  bool operator==(const BoxSides&) const = default;
};

/// Which sides of a measured box lie inside the image, farther than `border_px` from its border: a detector's
/// box hardly ever ends on the very last pixel.
inline BoxSides sidesInside(const Box2& box, const PinholeCamera& camera, double border_px = 2) {
  return {box.u_min > border_px, box.v_min > border_px, box.u_max < camera.width - border_px,
          box.v_max < camera.height - border_px};
}

}  // namespace roomgraph
