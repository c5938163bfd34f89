// SPDX-License-Identifier: BSD-3-Clause
// Shape models of objects (cylinder, cuboid, plane): footprint, distance, overlap.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <string>
#include <vector>

#include "roomgraph/geometry/pose.h"

namespace roomgraph {

enum class ShapeKind { kCylinder, kCuboid, kPlanar };

std::string toString(ShapeKind kind);
/// Throws std::invalid_argument for an unknown name.
ShapeKind shapeKindFromString(const std::string& name);

/// Size of an object's model. Object frame: origin at the bottom centre, x towards the front, y left, z up;
/// the model covers |x| <= depth / 2, |y| <= width / 2, 0 <= z <= height. A cylinder has width == depth == 2
/// r.
struct ObjectShape {
  ShapeKind kind = ShapeKind::kCuboid;
  double width = 0, depth = 0, height = 0;  ///< m; lateral, front to back, vertical
  double radius() const { return (width + depth) / 4; }
  double horizontalExtent() const { return std::max(width, depth); }
};

/// Corners of the footprint polygon (counter-clockwise, object frame, z = 0); a circle is sampled with
/// `circle` points.
std::vector<Eigen::Vector2d> footprint(const ObjectShape& shape, int circle = 24);

/// The same in the ground plane of another frame, from the object's pose there.
std::vector<Eigen::Vector2d> footprintAt(const Pose2& pose, const ObjectShape& shape, int circle = 24);

/// Distance from a point (object frame) to the model's volume: (horizontal, vertical), both 0 inside.
Eigen::Vector2d distanceOutside(const ObjectShape& shape, const Eigen::Vector3d& point);

/// Volume of the intersection over the volume of the union, for objects standing upright (poses differ by yaw
/// and translation). Cylinders are treated as polygons; planar shapes get at least `min_thickness_m`.
double iou3d(const ObjectShape& a, const Pose3& world_from_a, const ObjectShape& b, const Pose3& world_from_b,
             double min_thickness_m = 0.1);

/// Area of a convex counter-clockwise polygon's intersection with another; both in the same plane.
std::vector<Eigen::Vector2d> intersectConvex(const std::vector<Eigen::Vector2d>& a,
                                             const std::vector<Eigen::Vector2d>& b);
double polygonArea(const std::vector<Eigen::Vector2d>& polygon);

}  // namespace roomgraph
