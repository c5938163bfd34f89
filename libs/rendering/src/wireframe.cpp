// SPDX-License-Identifier: BSD-3-Clause
// Near-plane clipping and projection of edges, grid lines and horizon.
#include "wireframe.h"

#include <cmath>

namespace roomgraph {
namespace {

void add(std::vector<Segment2>& out, const std::optional<Segment2>& segment) {
  if (segment) out.push_back(*segment);
}

}  // namespace

std::optional<Segment2> projectSegment(Eigen::Vector3d a, Eigen::Vector3d b, const PinholeCamera& camera,
                                       double near_m) {
  if (a.z() < near_m && b.z() < near_m) return std::nullopt;
  const Eigen::Vector3d cut = a + (near_m - a.z()) / (b.z() - a.z()) * (b - a);
  if (a.z() < near_m) a = cut;
  if (b.z() < near_m) b = cut;
  return Segment2{camera.project(a), camera.project(b)};
}

std::vector<Segment2> wireframe(const ObjectShape& shape, const Pose3& camera_from_object,
                                const PinholeCamera& camera) {
  const std::vector<Eigen::Vector2d> base = footprint(shape, 24);
  const std::size_t upright = shape.kind == ShapeKind::kCylinder ? base.size() / 4 : 1;
  const auto corner = [&](std::size_t i, double z) {
    const Eigen::Vector2d& at = base[i % base.size()];
    return Eigen::Vector3d(camera_from_object * Eigen::Vector3d(at.x(), at.y(), z));
  };
  std::vector<Segment2> out;
  for (std::size_t i = 0; i < base.size(); ++i) {
    for (const double z : {0.0, shape.height})
      add(out, projectSegment(corner(i, z), corner(i + 1, z), camera));
    if (i % upright == 0) add(out, projectSegment(corner(i, 0), corner(i, shape.height), camera));
  }
  return out;
}

std::vector<Segment2> groundGrid(const Plane& ground, const PinholeCamera& camera, int range_m) {
  const Pose3 camera_from_ground = cameraFromGround(ground);
  const auto at = [&](double x, double y) {
    return Eigen::Vector3d(camera_from_ground * Eigen::Vector3d(x, y, 0));
  };
  std::vector<Segment2> out;
  for (int i = 0; i <= range_m; ++i) add(out, projectSegment(at(i, -range_m), at(i, range_m), camera));
  for (int i = -range_m; i <= range_m; ++i) add(out, projectSegment(at(0, i), at(range_m, i), camera));
  return out;
}

// Directions d on the ground have n . d = 0: the line n . K^-1 (u, v, 1) = 0.
std::optional<Segment2> horizon(const Plane& ground, const PinholeCamera& camera) {
  const Eigen::Vector3d& n = ground.normal;
  const double slope = n.y() / camera.fy;
  if (std::abs(n.y()) < 0.1) return std::nullopt;
  const auto v = [&](double u) { return camera.cy - (n.z() + n.x() * (u - camera.cx) / camera.fx) / slope; };
  return Segment2{{0, v(0)}, {camera.width - 1.0, v(camera.width - 1.0)}};
}

}  // namespace roomgraph
