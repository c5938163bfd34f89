// SPDX-License-Identifier: BSD-3-Clause
// Local ground frame below the camera, and ray-plane intersection.
#include "roomgraph/geometry/ground.h"

namespace roomgraph {

Plane transformed(const Pose3& a_from_b, const Plane& plane_in_b) {
  const Eigen::Vector3d normal = a_from_b.linear() * plane_in_b.normal;
  return {normal, plane_in_b.offset - normal.dot(a_from_b.translation())};
}

Plane groundInCamera(const Pose3& world_from_camera) {
  return {world_from_camera.linear().transpose() * Eigen::Vector3d::UnitZ(),
          world_from_camera.translation().z()};
}

Pose3 cameraFromGround(const Plane& ground) {
  const Eigen::Vector3d up = ground.normal.normalized();
  Eigen::Vector3d forward = Eigen::Vector3d::UnitZ() - up.z() * up;
  // Optical axis vertical: its horizontal direction is undefined, the image's up direction takes its place.
  if (forward.norm() < 1e-6) forward = -Eigen::Vector3d::UnitY() + up.y() * up;
  forward.normalize();
  Pose3 pose = Pose3::Identity();
  pose.linear() << forward, up.cross(forward), up;
  pose.translation() = -ground.offset * up;
  return pose;
}

std::optional<Eigen::Vector3d> intersect(const Eigen::Vector3d& direction, const Plane& plane) {
  const double slope = plane.normal.dot(direction);
  if (std::abs(slope) < 1e-9 * direction.norm()) return std::nullopt;
  const double lambda = -plane.offset / slope;
  if (lambda <= 0) return std::nullopt;
  return lambda * direction;
}

}  // namespace roomgraph
