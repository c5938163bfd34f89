// SPDX-License-Identifier: BSD-3-Clause
// Names of shapes; footprint and distance of a point for plain numbers.
#include "roomgraph/geometry/shape.h"

#include <stdexcept>

#include "roomgraph/geometry/shape_math.h"

namespace roomgraph {

std::string toString(ShapeKind kind) {
  switch (kind) {
    case ShapeKind::kCylinder:
      return "cylinder";
    case ShapeKind::kCuboid:
      return "cuboid";
    case ShapeKind::kPlanar:
      return "planar";
  }
  throw std::invalid_argument("unknown shape kind");
}

ShapeKind shapeKindFromString(const std::string& name) {
  if (name == "cylinder") return ShapeKind::kCylinder;
  if (name == "cuboid") return ShapeKind::kCuboid;
  if (name == "planar") return ShapeKind::kPlanar;
  throw std::invalid_argument("'" + name + "' is no shape; known: cylinder, cuboid, planar");
}

std::vector<Eigen::Vector2d> footprint(const ObjectShape& shape, int circle) {
  return footprintCorners<double>(shape.kind, sizeOf(shape), circle);
}

std::vector<Eigen::Vector2d> footprintAt(const Pose2& pose, const ObjectShape& shape, int circle) {
  auto corners = footprint(shape, circle);
  for (auto& corner : corners) corner = pose * corner;
  return corners;
}

Eigen::Vector2d distanceOutside(const ObjectShape& shape, const Eigen::Vector3d& point) {
  const auto [horizontal, vertical] = distanceOutside<double>(shape.kind, sizeOf(shape), point);
  return {horizontal, vertical};
}

}  // namespace roomgraph
