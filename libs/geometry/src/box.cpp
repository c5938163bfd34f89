// SPDX-License-Identifier: BSD-3-Clause
// Intersection, clipping and IoU of image rectangles.
#include "roomgraph/geometry/box.h"

#include <algorithm>

namespace roomgraph {

Box2 intersection(const Box2& a, const Box2& b) {
  Box2 common{std::max(a.u_min, b.u_min), std::max(a.v_min, b.v_min), std::min(a.u_max, b.u_max),
              std::min(a.v_max, b.v_max)};
  return common.empty() ? Box2{} : common;
}

Box2 clipped(const Box2& box, int width, int height) {
  return intersection(box, {0, 0, static_cast<double>(width), static_cast<double>(height)});
}

double iou(const Box2& a, const Box2& b) {
  const double common = intersection(a, b).area();
  const double all = a.area() + b.area() - common;
  return all > 0 ? common / all : 0;
}

}  // namespace roomgraph
