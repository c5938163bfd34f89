// SPDX-License-Identifier: BSD-3-Clause
// Ground contact and bearing of a detection's box.
#include "roomgraph/proposals/box_evidence.h"

#include <cmath>

namespace roomgraph {

std::optional<Eigen::Vector2d> contactPoint(const BoxEvidence& e) {
  if (e.cut.bottom) return std::nullopt;
  const auto point = intersect(e.camera.ray(e.box.center().x(), e.box.v_max), e.ground);
  if (!point) return std::nullopt;
  const Eigen::Vector3d in_ground = e.camera_from_ground.inverse() * *point;
  if (in_ground.norm() > kFarthestGround_m) return std::nullopt;
  return in_ground.head<2>();
}

namespace {

double azimuth(const BoxEvidence& e, double u) {
  // At the bottom of the object, not at the horizon: a rolled camera sees vertical lines slanted.
  const double v = e.cut.bottom ? e.box.center().y() : e.box.v_max;
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
