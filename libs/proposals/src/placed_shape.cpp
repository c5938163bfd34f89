// SPDX-License-Identifier: BSD-3-Clause
// Poses and projection of a placed shape.
#include "roomgraph/proposals/placed_shape.h"

#include <algorithm>

#include "roomgraph/core/order_statistics.h"

namespace roomgraph {

bool heightKnown(const BoxEvidence& evidence) {
  return evidence.model->rests_on_ground || !evidence.mask.points.empty();
}

PlacedShape usualShape(const BoxEvidence& evidence) {
  constexpr double kLowest = 0.03;  // quantile of the heights taken for the lowest point
  PlacedShape placed;
  placed.shape = evidence.model->nominal();
  if (evidence.model->rests_on_ground) return placed;
  std::vector<double> heights;
  for (const MaskPoint& point : evidence.mask.points) heights.push_back(point.in_ground.z());
  placed.z = quantile(std::move(heights), kLowest);
  return placed;
}

Pose3 groundFromObject(const PlacedShape& placed) {
  Pose3 pose = toPose3(Pose2{placed.x, placed.y, placed.yaw});
  pose.translation().z() = placed.z;
  return pose;
}

Pose3 cameraFromObject(const PlacedShape& placed, const BoxEvidence& evidence) {
  Pose3 camera_from_object = evidence.camera_from_ground * groundFromObject(placed);
  if (placed.roll == 0 && placed.pitch == 0) return camera_from_object;
  const Eigen::Matrix3d& axes = evidence.camera_from_ground.linear();
  return Pose3(expSO3(axes * Eigen::Vector3d(placed.roll, placed.pitch, 0))) * camera_from_object;
}

std::optional<ProjectedShape> project(const PlacedShape& placed, const BoxEvidence& evidence) {
  return projectShape(placed.shape, cameraFromObject(placed, evidence), evidence.camera);
}

Box2 unhidden(const Box2& visible, const Box2& box, const BoxSides& hidden) {
  return {hidden.left ? std::max(visible.u_min, box.u_min) : visible.u_min,
          hidden.top ? std::max(visible.v_min, box.v_min) : visible.v_min,
          hidden.right ? std::min(visible.u_max, box.u_max) : visible.u_max,
          hidden.bottom ? std::min(visible.v_max, box.v_max) : visible.v_max};
}

double boxIou(const PlacedShape& placed, const BoxEvidence& evidence) {
  const auto projected = project(placed, evidence);
  return projected ? iou(unhidden(projected->visible, evidence.box, evidence.hidden), evidence.box) : 0;
}

}  // namespace roomgraph
