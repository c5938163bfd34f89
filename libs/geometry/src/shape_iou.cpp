// SPDX-License-Identifier: BSD-3-Clause
// 3D IoU of upright shapes by clipping of their footprint polygons.
#include <algorithm>
#include <cmath>

#include "roomgraph/geometry/convex_polygon.h"
#include "roomgraph/geometry/shape.h"

namespace roomgraph {
namespace {

constexpr int kCorners = 64;  // of a circle

ObjectShape atLeastAsThick(ObjectShape shape, double thickness) {
  if (shape.kind != ShapeKind::kCylinder) {
    shape.width = std::max(shape.width, thickness);
    shape.depth = std::max(shape.depth, thickness);
  }
  return shape;
}

}  // namespace

double polygonArea(const std::vector<Eigen::Vector2d>& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    twice += cross2<double>(polygon[i], polygon[(i + 1) % polygon.size()]);
  return twice / 2;
}

std::vector<Eigen::Vector2d> intersectConvex(const std::vector<Eigen::Vector2d>& a,
                                             const std::vector<Eigen::Vector2d>& b) {
  std::vector<Eigen::Vector2d> rest = a;
  for (std::size_t k = 0; k < b.size(); ++k) rest = leftOf<double>(rest, b[k], b[(k + 1) % b.size()] - b[k]);
  return rest;
}

double iou3d(const ObjectShape& a, const Pose3& world_from_a, const ObjectShape& b, const Pose3& world_from_b,
             double min_thickness_m) {
  const auto base_a = footprintAt(planarPart(world_from_a), atLeastAsThick(a, min_thickness_m), kCorners);
  const auto base_b = footprintAt(planarPart(world_from_b), atLeastAsThick(b, min_thickness_m), kCorners);
  const double za = world_from_a.translation().z(), zb = world_from_b.translation().z();
  const double overlap = std::min(za + a.height, zb + b.height) - std::max(za, zb);
  const double common = std::max(0.0, overlap) * polygonArea(intersectConvex(base_a, base_b));
  const double all = polygonArea(base_a) * a.height + polygonArea(base_b) * b.height - common;
  return all > 0 ? common / all : 0;
}

}  // namespace roomgraph
