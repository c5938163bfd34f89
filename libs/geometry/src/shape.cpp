// SPDX-License-Identifier: BSD-3-Clause
// Names of shapes, footprint polygon, and distance of a point from the volume.
#include "roomgraph/geometry/shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

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
  std::vector<Eigen::Vector2d> corners;
  if (shape.kind == ShapeKind::kCylinder) {
    for (int i = 0; i < circle; ++i) {
      const double angle = 2 * std::numbers::pi * i / circle;
      corners.emplace_back(shape.radius() * std::cos(angle), shape.radius() * std::sin(angle));
    }
    return corners;
  }
  const double x = shape.depth / 2, y = shape.width / 2;
  return {{x, -y}, {x, y}, {-x, y}, {-x, -y}};
}

Eigen::Vector2d distanceOutside(const ObjectShape& shape, const Eigen::Vector3d& point) {
  const double vertical = std::max({0.0, -point.z(), point.z() - shape.height});
  if (shape.kind == ShapeKind::kCylinder)
    return {std::max(0.0, point.head<2>().norm() - shape.radius()), vertical};
  const double dx = std::max(0.0, std::abs(point.x()) - shape.depth / 2);
  const double dy = std::max(0.0, std::abs(point.y()) - shape.width / 2);
  return {std::hypot(dx, dy), vertical};
}

}  // namespace roomgraph
