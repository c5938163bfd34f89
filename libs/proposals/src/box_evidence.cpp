// SPDX-License-Identifier: BSD-3-Clause
// Evidence about a detection: cut and hidden box sides, mask, ground contact, bearing.
#include <algorithm>
#include <cmath>

#include "generators.h"

namespace roomgraph {

namespace {

void markBorder(BoxEvidence& e) {
  constexpr double kBorder = 3;  // px
  e.cut_left = e.box.u_min <= kBorder;
  e.cut_top = e.box.v_min <= kBorder;
  e.cut_right = e.box.u_max >= e.camera.width - kBorder;
  e.cut_bottom = e.box.v_max >= e.camera.height - kBorder;
}

// Whether most of what lies along the line from a to b (px, just outside the box) stands nearer than the
// object.
bool hiddenAlong(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double object_range,
                 const BoxEvidence& e, const Frame& frame) {
  constexpr int kSamples = 24;
  constexpr double kShare = 0.4, kNearer = 0.15, kStanding = 0.12;  // m: nearer by, higher than
  const Pose3 ground_from_camera = e.camera_from_ground.inverse();
  int hiding = 0;
  for (int i = 0; i < kSamples; ++i) {
    const Eigen::Vector2d p = a + (i + 0.5) / kSamples * (b - a);
    const float z = frame.depthAt(p.x(), p.y());
    if (!(z > 0) || !std::isfinite(z)) continue;
    const Eigen::Vector3d q = ground_from_camera * e.camera.backProject(p.x(), p.y(), z);
    hiding += q.z() > kStanding && q.head<2>().norm() < object_range - kNearer;
  }
  return hiding >= kShare * kSamples;
}

// A side that stops at a nearer object says no more about the model than one at the image border.
void markHidden(BoxEvidence& e, const Frame& frame) {
  if (e.mask.points.empty() || !frame.hasDepth()) return;
  std::vector<double> ranges;
  for (const auto& p : e.mask.points) ranges.push_back(p.in_ground.head<2>().norm());
  const double range = quantile(std::move(ranges), 0.1);
  const Box2& b = e.box;
  const double du = 3 + 0.02 * b.width(), dv = 3 + 0.02 * b.height();
  const auto along = [&](double u0, double v0, double u1, double v1) {
    return hiddenAlong({u0, v0}, {u1, v1}, range, e, frame);
  };
  e.hidden.left = !e.cut_left && along(b.u_min - du, b.v_min, b.u_min - du, b.v_max);
  e.hidden.right = !e.cut_right && along(b.u_max + du, b.v_min, b.u_max + du, b.v_max);
  e.hidden.top = !e.cut_top && along(b.u_min, b.v_min - dv, b.u_max, b.v_min - dv);
  e.hidden.bottom = !e.cut_bottom && along(b.u_min, b.v_max + dv, b.u_max, b.v_max + dv);
  e.cut_left |= e.hidden.left;
  e.cut_right |= e.hidden.right;
  e.cut_top |= e.hidden.top;
  e.cut_bottom |= e.hidden.bottom;
}

}  // namespace

BoxEvidence gatherEvidence(const Frame& frame, const Detection& detection, const ObjectModel& model,
                           const Plane& ground) {
  BoxEvidence e;
  e.camera = frame.camera;
  e.ground = ground;
  e.camera_from_ground = cameraFromGround(ground);
  e.box = clipped(detection.box, frame.camera.width, frame.camera.height);
  e.model = &model;
  e.edges = findEdges(frame, e.box);
  e.all = sampleBox(frame, detection, e.camera_from_ground.inverse());
  auto masks = explanations(e.all, e.box, model, frame.camera.fx, 2);
  masks.resize(2);
  masks[0].valid_ratio = e.all.valid_ratio;
  e.other_mask = std::move(masks[1]);
  return withMask(e, masks[0], frame);
}

BoxEvidence withMask(const BoxEvidence& evidence, const DepthMask& mask, const Frame& frame) {
  BoxEvidence e = evidence;
  e.mask = mask;
  e.hidden = {};
  e.segments = supportedSegments(e.edges.segments, mask, e.box);
  if (mask.points.empty()) addDistances(e.edges);
  markBorder(e);
  markHidden(e, frame);
  return e;
}

Pose3 groundFromObject(const PlacedShape& placed) {
  return toPose3(Pose2{placed.x, placed.y, placed.yaw});
}

Pose3 cameraFromObject(const PlacedShape& placed, const BoxEvidence& evidence) {
  const Pose3 camera_from_object = evidence.camera_from_ground * groundFromObject(placed);
  if (placed.roll == 0 && placed.pitch == 0) return camera_from_object;
  const Eigen::Matrix3d& axes = evidence.camera_from_ground.linear();
  return Pose3(expSO3(axes * Eigen::Vector3d(placed.roll, placed.pitch, 0))) * camera_from_object;
}

std::optional<ProjectedShape> project(const PlacedShape& placed, const BoxEvidence& evidence) {
  return projectShape(placed.shape, cameraFromObject(placed, evidence), evidence.camera);
}

double boxIou(const PlacedShape& placed, const BoxEvidence& evidence) {
  const auto projected = project(placed, evidence);
  if (!projected) return 0;
  Box2 seen = projected->visible;
  const Box2& box = evidence.box;
  if (evidence.hidden.left) seen.u_min = std::max(seen.u_min, box.u_min);
  if (evidence.hidden.top) seen.v_min = std::max(seen.v_min, box.v_min);
  if (evidence.hidden.right) seen.u_max = std::min(seen.u_max, box.u_max);
  if (evidence.hidden.bottom) seen.v_max = std::min(seen.v_max, box.v_max);
  return iou(seen, box);
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

}  // namespace roomgraph
