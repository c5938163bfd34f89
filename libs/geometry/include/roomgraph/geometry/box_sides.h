// SPDX-License-Identifier: BSD-3-Clause
// Flags for the four sides of an image box, and which sides lie inside the image rather than on its border.
#pragma once

#include <array>
#include <limits>

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

/// A side this near to the image border (px) is cut by it: a detector's box hardly ever ends on the very last
/// pixel.
inline constexpr double kImageBorder_px = 3;

/// Which sides of a measured box lie inside an image of this size (px), off its border.
inline BoxSides sidesInside(const Box2& box, int width, int height) {
  return {box.u_min > kImageBorder_px, box.v_min > kImageBorder_px, box.u_max < width - kImageBorder_px,
          box.v_max < height - kImageBorder_px};
}

inline BoxSides sidesInside(const Box2& box, const PinholeCamera& camera) {
  return sidesInside(box, camera.width, camera.height);
}

/// The part of the image between those sides of the box that are said to be cut; infinite to the others.
inline Box2 windowBetween(const Box2& box, const BoxSides& cut) {
  constexpr double kOpen = std::numeric_limits<double>::infinity();
  return {cut.left ? box.u_min : -kOpen, cut.top ? box.v_min : -kOpen, cut.right ? box.u_max : kOpen,
          cut.bottom ? box.v_max : kOpen};
}

/// The part of the image in which the object of a measured box was looked for: it ends at those image borders that cut the
/// box, and nowhere else.
inline Box2 windowOf(const Box2& box, const PinholeCamera& camera) {
  const BoxSides inside = sidesInside(box, camera);
  return windowBetween({0, 0, static_cast<double>(camera.width), static_cast<double>(camera.height)},
                       {!inside.left, !inside.top, !inside.right, !inside.bottom});
}

}  // namespace roomgraph
