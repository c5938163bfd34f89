// SPDX-License-Identifier: BSD-3-Clause
// Silhouette bounds by near-plane clipping of prisms and by the dual conic of circles.
#include "roomgraph/geometry/projection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace roomgraph {
namespace {

struct Bounds {
  double u_min = std::numeric_limits<double>::infinity(), v_min = u_min, u_max = -u_min, v_max = -u_min;
  bool any = false;
  void add(const Eigen::Vector2d& p) {
    u_min = std::min(u_min, p.x());
    u_max = std::max(u_max, p.x());
    v_min = std::min(v_min, p.y());
    v_max = std::max(v_max, p.y());
    any = true;
  }
  void add(const Box2& box) {
    add(Eigen::Vector2d(box.u_min, box.v_min));
    add(Eigen::Vector2d(box.u_max, box.v_max));
  }
};

void addEdge(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const PinholeCamera& camera, double near_m,
             Bounds& bounds) {
  if (p.z() < near_m && q.z() < near_m) return;
  if (p.z() >= near_m) bounds.add(camera.project(p));
  if (q.z() >= near_m) bounds.add(camera.project(q));
  if ((p.z() < near_m) != (q.z() < near_m)) {
    const double ratio = (near_m - p.z()) / (q.z() - p.z());
    bounds.add(camera.project(p + ratio * (q - p)));
  }
}

// A prism over the footprint polygon: exact for boxes, and for round shapes cut by the near plane.
void addPrism(const std::vector<Eigen::Vector2d>& base, double height, const Pose3& camera_from_object,
              const PinholeCamera& camera, double near_m, Bounds& bounds) {
  for (std::size_t i = 0; i < base.size(); ++i) {
    const Eigen::Vector2d &a = base[i], &b = base[(i + 1) % base.size()];
    const Eigen::Vector3d a0 = camera_from_object * Eigen::Vector3d(a.x(), a.y(), 0);
    const Eigen::Vector3d a1 = camera_from_object * Eigen::Vector3d(a.x(), a.y(), height);
    const Eigen::Vector3d b0 = camera_from_object * Eigen::Vector3d(b.x(), b.y(), 0);
    const Eigen::Vector3d b1 = camera_from_object * Eigen::Vector3d(b.x(), b.y(), height);
    addEdge(a0, b0, camera, near_m, bounds);
    addEdge(a1, b1, camera, near_m, bounds);
    addEdge(a0, a1, camera, near_m, bounds);
  }
}

}  // namespace

std::optional<Box2> projectCircle(const Eigen::Vector3d& center, const Eigen::Vector3d& normal, double radius,
                                  const PinholeCamera& camera) {
  // Wholly in front: the nearest point of the circle is radius * |n x z| closer than its centre.
  const double reach = radius * normal.head<2>().norm();
  if (center.z() - reach <= 1e-6) return std::nullopt;
  // Dual of the circle in 3D is c cᵀ - r² (I - n nᵀ); its image K Q* Kᵀ is the dual of the projected conic,
  // whose tangent lines u = const and v = const bound it.
  const Eigen::Matrix3d dual = center * center.transpose() -
                               radius * radius * (Eigen::Matrix3d::Identity() - normal * normal.transpose());
  const Eigen::Matrix3d image = camera.matrix() * dual * camera.matrix().transpose();
  const auto bounds = [&](int axis) {
    const double c22 = image(2, 2), c02 = image(axis, 2), c00 = image(axis, axis);
    const double root = std::sqrt(std::max(0.0, c02 * c02 - c22 * c00));
    return std::array<double, 2>{(c02 - root) / c22, (c02 + root) / c22};
  };
  const auto u = bounds(0), v = bounds(1);
  return Box2{u[0], v[0], u[1], v[1]};
}

std::optional<ProjectedShape> projectShape(const ObjectShape& shape, const Pose3& camera_from_object,
                                           const PinholeCamera& camera, double near_m) {
  Bounds bounds;
  const Eigen::Vector3d up = camera_from_object.linear().col(2);
  const Eigen::Vector3d bottom = camera_from_object.translation(), top = bottom + shape.height * up;
  const double reach = shape.radius() * up.head<2>().norm();
  if (shape.kind == ShapeKind::kCylinder && std::min(bottom.z(), top.z()) - reach > near_m) {
    for (const auto& center : {bottom, top})
      if (const auto box = projectCircle(center, up, shape.radius(), camera)) bounds.add(*box);
  } else {
    addPrism(footprint(shape, 48), shape.height, camera_from_object, camera, near_m, bounds);
  }
  if (!bounds.any) return std::nullopt;
  ProjectedShape out;
  out.full = {bounds.u_min, bounds.v_min, bounds.u_max, bounds.v_max};
  out.visible = clipped(out.full, camera.width, camera.height);
  if (out.visible.empty()) return std::nullopt;
  out.cut_left = out.full.u_min < 0;
  out.cut_top = out.full.v_min < 0;
  out.cut_right = out.full.u_max > camera.width;
  out.cut_bottom = out.full.v_max > camera.height;
  return out;
}

}  // namespace roomgraph
