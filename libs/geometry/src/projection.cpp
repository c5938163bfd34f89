// SPDX-License-Identifier: BSD-3-Clause
// Image extent of a shape model for plain numbers, with the part inside the image.
#include "roomgraph/geometry/projection.h"

#include "roomgraph/geometry/projected_bounds.h"

namespace roomgraph {

std::optional<ProjectedShape> projectShape(const ObjectShape& shape, const Pose3& camera_from_object,
                                           const PinholeCamera& camera, double near_m) {
  const auto bounds = projectedBounds<double>(shape.kind, sizeOf(shape), camera_from_object.linear(),
                                              camera_from_object.translation(), camera, near_m);
  if (!bounds) return std::nullopt;
  const auto& [u_min, v_min, u_max, v_max] = *bounds;
  ProjectedShape out;
  out.full = {u_min, v_min, u_max, v_max};
  const Box2 image{0, 0, static_cast<double>(camera.width), static_cast<double>(camera.height)};
  const auto inside = boundsWithin(image, shape, camera_from_object, camera, near_m);
  if (!inside || inside->empty()) return std::nullopt;
  out.visible = *inside;
  out.cut.left = u_min < 0;
  out.cut.top = v_min < 0;
  out.cut.right = u_max > camera.width;
  out.cut.bottom = v_max > camera.height;
  return out;
}

std::optional<Box2> boundsWithin(const Box2& window, const ObjectShape& shape, const Pose3& camera_from_object,
                                 const PinholeCamera& camera, double near_m) {
  const auto bounds = boundsWithin<double>(window, shape.kind, sizeOf(shape), camera_from_object.linear(),
                                           camera_from_object.translation(), camera, near_m);
  if (!bounds) return std::nullopt;
  return Box2{(*bounds)[0], (*bounds)[1], (*bounds)[2], (*bounds)[3]};
}

}  // namespace roomgraph
