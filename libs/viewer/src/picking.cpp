// SPDX-License-Identifier: BSD-3-Clause
// Intersection of rays with boxes (slabs) and upright cylinders.
#include "roomgraph/viewer/picking.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace roomgraph {
namespace {

constexpr double kLeastThickness_m = 0.1;

/// The part of a ray that is inside of something: from, to.
struct Span {
  double from = 0, to = std::numeric_limits<double>::infinity();
  void cut(double a, double b) {
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  void clear() { to = -1; }
};

void cutSlab(Span& span, double origin, double direction, double low, double high) {
  if (std::abs(direction) > 1e-12)
    span.cut((low - origin) / direction, (high - origin) / direction);
  else if (origin < low || origin > high)
    span.clear();
}

void cutCylinder(Span& span, const Eigen::Vector2d& origin, const Eigen::Vector2d& direction, double radius) {
  const double a = direction.squaredNorm(), b = origin.dot(direction),
               c = origin.squaredNorm() - radius * radius;
  if (a < 1e-12) {
    if (c > 0) span.clear();
    return;
  }
  const double discriminant = b * b - a * c;
  if (discriminant < 0)
    span.clear();
  else
    span.cut((-b - std::sqrt(discriminant)) / a, (-b + std::sqrt(discriminant)) / a);
}

}  // namespace

std::optional<double> distanceToObject(const OrbitCamera::Ray& ray, const ObjectShape& shape,
                                       const Pose3& world_from_object) {
  const Pose3 object_from_world = world_from_object.inverse();
  const Eigen::Vector3d origin = object_from_world * ray.origin();
  const Eigen::Vector3d direction = object_from_world.linear() * ray.direction();
  Span span;
  cutSlab(span, origin.z(), direction.z(), 0, std::max(shape.height, kLeastThickness_m));
  if (shape.kind == ShapeKind::kCylinder) {
    cutCylinder(span, origin.head<2>(), direction.head<2>(), std::max(shape.radius(), kLeastThickness_m / 2));
  } else {
    const double depth = std::max(shape.depth, kLeastThickness_m),
                 width = std::max(shape.width, kLeastThickness_m);
    cutSlab(span, origin.x(), direction.x(), -depth / 2, depth / 2);
    cutSlab(span, origin.y(), direction.y(), -width / 2, width / 2);
  }
  if (span.from > span.to) return std::nullopt;
  return span.from;
}

LandmarkId pickLandmark(const OrbitCamera::Ray& ray, const ShownLandmarks& landmarks, bool with_candidates) {
  LandmarkId nearest;
  for (const bool in_map : {true, false}) {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& shown : landmarks) {
      if (shown->in_map != in_map) continue;
      const auto distance = distanceToObject(ray, shown->landmark.shape, shown->landmark.worldFromObject());
      if (!distance || *distance >= least) continue;
      least = *distance;
      nearest = shown->landmark.id;
    }
    if (nearest.valid() || !with_candidates) break;
  }
  return nearest;
}

}  // namespace roomgraph
