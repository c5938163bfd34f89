// SPDX-License-Identifier: BSD-3-Clause
// Camera, random shapes and viewpoints for the tests of object factors.
#pragma once

#include "random_poses.h"
#include "roomgraph/geometry/camera.h"
#include "roomgraph/geometry/shape.h"

namespace roomgraph::test {

inline PinholeCamera testCamera() {
  return {.width = 640, .height = 480, .fx = 400, .fy = 300, .cx = 320, .cy = 240};
}

inline ObjectShape randomShape(Random& random) {
  ObjectShape shape{static_cast<ShapeKind>(random.index(3)), random.uniform(0.5, 1.5),
                    random.uniform(0.5, 1.5), random.uniform(0.5, 1.5)};
  if (shape.kind == ShapeKind::kCylinder) shape.depth = shape.width;
  return shape;
}

/// world_from_camera at a place, looking at another, rolled about the line of sight.
inline Pose3 lookingAt(const Eigen::Vector3d& from, const Eigen::Vector3d& target, double roll) {
  Pose3 pose = Pose3::Identity();
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), target - from);
  pose.linear() =
      turn.toRotationMatrix() * Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  pose.translation() = from;
  return pose;
}

}  // namespace roomgraph::test
