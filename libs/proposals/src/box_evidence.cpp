// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include <algorithm>
#include <cmath>

#include "roomgraph/proposals/generators.h"

namespace roomgraph {

BoxEvidence gatherEvidence(const Frame& frame, const Detection& detection, const ObjectModel& model,
                           const Plane& ground) {
  constexpr double kBorder = 3;  // px
  BoxEvidence e;
  e.camera = frame.camera;
  e.ground = ground;
  e.camera_from_ground = cameraFromGround(ground);
  e.box = clipped(detection.box, frame.camera.width, frame.camera.height);
  e.cut_left = e.box.u_min <= kBorder;
  e.cut_top = e.box.v_min <= kBorder;
  e.cut_right = e.box.u_max >= frame.camera.width - kBorder;
  e.cut_bottom = e.box.v_max >= frame.camera.height - kBorder;
  e.model = &model;
  e.all = sampleBox(frame, detection, e.camera_from_ground.inverse());
  e.mask = explainBox(e.all, e.box, model, frame.camera.fx);
  return e;
}

Pose3 groundFromObject(const PlacedShape& placed) {
  return toPose3(Pose2{placed.x, placed.y, placed.yaw});
}

std::optional<ProjectedShape> project(const PlacedShape& placed, const BoxEvidence& evidence) {
  return projectShape(placed.shape, evidence.camera_from_ground * groundFromObject(placed), evidence.camera);
}

double boxIou(const PlacedShape& placed, const BoxEvidence& evidence) {
  const auto projected = project(placed, evidence);
  return projected ? iou(projected->visible, evidence.box) : 0;
}

std::optional<Eigen::Vector2d> contactPoint(const BoxEvidence& e) {
  constexpr double kFarthest = 20;  // m; beyond, a pixel is metres
  if (e.cut_bottom) return std::nullopt;
  const auto point = intersect(e.camera.ray(e.box.center().x(), e.box.v_max), e.ground);
  if (!point) return std::nullopt;
  const Eigen::Vector3d in_ground = e.camera_from_ground.inverse() * *point;
  if (in_ground.norm() > kFarthest) return std::nullopt;
  return in_ground.head<2>();
}

namespace {

double azimuth(const BoxEvidence& e, double u) {
  // At the height where the object stands, not at the horizon: a rolled or pitched camera sees columns
  // slanted.
  const double v = e.cut_bottom ? e.box.center().y() : e.box.v_max;
  const Eigen::Vector3d direction = e.camera_from_ground.linear().transpose() * e.camera.ray(u, v);
  return std::atan2(direction.y(), direction.x());
}

}  // namespace

double bearingOf(const BoxEvidence& e) {
  return azimuth(e, e.box.center().x());
}

double halfAngleOf(const BoxEvidence& e) {
  return std::abs(wrapAngle(azimuth(e, e.box.u_min) - azimuth(e, e.box.u_max))) / 2;
}

double quantile(std::vector<double> values, double ratio) {
  if (values.empty()) return 0;
  const auto index = static_cast<std::ptrdiff_t>(ratio * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + index, values.end());
  return values[index];
}

}  // namespace roomgraph
