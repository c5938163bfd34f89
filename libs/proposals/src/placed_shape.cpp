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

std::optional<Box2> visibleBounds(const PlacedShape& placed, const BoxEvidence& evidence) {
  const Box2 window = windowBetween(evidence.box, placed.hidden);
  const Box2 seen{std::max(window.u_min, 0.0), std::max(window.v_min, 0.0),
                  std::min<double>(window.u_max, evidence.camera.width), std::min<double>(window.v_max, evidence.camera.height)};
  return boundsWithin(seen, placed.shape, cameraFromObject(placed, evidence), evidence.camera);
}

double boxIou(const PlacedShape& placed, const BoxEvidence& evidence) {
  const auto seen = visibleBounds(placed, evidence);
  return seen ? iou(*seen, evidence.box) : 0;
}

}  // namespace roomgraph
