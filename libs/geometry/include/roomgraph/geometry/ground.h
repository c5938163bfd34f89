// SPDX-License-Identifier: BSD-3-Clause
// Planes, the ground plane in the camera frame, and intersection of rays with it.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// Plane normal . x + offset = 0 with unit normal; positive distance on the normal's side.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset = 0;
  double distance(const Eigen::Vector3d& p) const { return normal.dot(p) + offset; }
};

/// The same plane in another frame.
Plane transformed(const Pose3& a_from_b, const Plane& plane_in_b);

/// Ground z = 0 of world, as a plane in the camera frame (normal up, offset = camera height above ground).
Plane groundInCamera(const Pose3& world_from_camera);

/// Pose of the local ground frame (method.md sec. 0) in the camera: origin on the ground below the camera, z
/// along the normal, x along the optical axis' horizontal direction.
Pose3 cameraFromGround(const Plane& ground);

/// Where a ray from the camera centre meets the plane (paper Eq. 2); nothing when it is parallel to the
/// plane, meets it behind the camera, or above the horizon.
std::optional<Eigen::Vector3d> intersect(const Eigen::Vector3d& direction, const Plane& plane);

}  // namespace roomgraph
