// SPDX-License-Identifier: BSD-3-Clause
// Visible edges of a cuboid against the distance transform; angles of segments to vanishing points.
#include "edge_agreement.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace roomgraph {
namespace {

constexpr double kNear = 0.05;          // m; edges nearer to the camera are not compared
constexpr double kAngle = 0.12;         // rad; a segment this far off its vanishing point counts 1/e
constexpr int kEdgeSteps = 12;          // intervals per edge
constexpr double kOutlineShare = 0.5;   // of the agreement; the rest is that of the segments
// Distance at which a point of the outline counts 1/e: a constant, px, and a share of the box's diagonal.
constexpr double kOffEdge_px = 2, kOffEdgeShare = 0.02;

/// Corner k of a cuboid: bit 0 front, bit 1 left, bit 2 up.
Eigen::Vector3d corner(const ObjectShape& s, int k) {
  return {(k & 1 ? s.depth : -s.depth) / 2, (k & 2 ? s.width : -s.width) / 2, k & 4 ? s.height : 0};
}

// Whether the camera sees the face on which bit `axis` of the corners has the given value.
bool faceSeen(const ObjectShape& s, const Eigen::Vector3d& camera, int axis, bool high) {
  const double low_side = axis == 2 ? 0 : (axis == 0 ? -s.depth : -s.width) / 2;
  const double high_side = axis == 2 ? s.height : -low_side;
  return high ? camera[axis] > high_side : camera[axis] < low_side;
}

// An edge is visible when one of its two faces is.
bool edgeSeen(const ObjectShape& s, const Eigen::Vector3d& camera, int from, int along) {
  for (int axis = 0; axis < 3; ++axis)
    if (axis != along && faceSeen(s, camera, axis, (from >> axis) & 1)) return true;
  return false;
}

// Mean over the visible edges' points of exp(-distance to the nearest image edge / scale): 1 when all are on edges.
double outlineAgreement(const PlacedShape& placed, const BoxEvidence& e) {
  const Pose3 camera_from_object = cameraFromObject(placed, e);
  const Eigen::Vector3d camera = camera_from_object.inverse().translation();
  const double scale = kOffEdge_px + kOffEdgeShare * e.box.diagonal();  // px
  double sum = 0;
  int count = 0;
  for (int along = 0; along < 3; ++along)
    for (int from = 0; from < 8; ++from) {
      if (((from >> along) & 1) || !edgeSeen(placed.shape, camera, from, along)) continue;
      const Eigen::Vector3d a = camera_from_object * corner(placed.shape, from),
                            b = camera_from_object * corner(placed.shape, from | (1 << along));
      if (a.z() < kNear || b.z() < kNear) continue;
      const Eigen::Vector2d pa = e.camera.project(a), pb = e.camera.project(b);
      for (int i = 0; i <= kEdgeSteps; ++i) {
        const Eigen::Vector2d p = pa + (pb - pa) * i / kEdgeSteps;
        if (!e.camera.sees(p.x(), p.y()) || (e.hidden.left && p.x() < e.box.u_min) ||
            (e.hidden.right && p.x() > e.box.u_max) || (e.hidden.top && p.y() < e.box.v_min) ||
            (e.hidden.bottom && p.y() > e.box.v_max))
          continue;
        sum += std::exp(-e.edges.distanceAt(p) / scale);
        ++count;
      }
    }
  return count > 0 ? sum / count : 0;
}

// Angle between a segment and the direction from its middle to a vanishing point.
double angleTo(const Segment2& s, const Eigen::Vector3d& vanishing) {
  const Eigen::Vector2d middle = (s.a + s.b) / 2, along = s.b - s.a;
  const Eigen::Vector2d towards = vanishing.head<2>() - vanishing.z() * middle;
  const double cross = along.x() * towards.y() - along.y() * towards.x();
  return std::atan2(std::abs(cross), std::abs(along.dot(towards)));
}

double segmentAgreement(const PlacedShape& placed, const BoxEvidence& e) {
  const auto points = vanishingPoints(placed, e);
  double sum = 0, total = 0;
  for (const Segment2& s : e.segments) {
    const double length = (s.b - s.a).norm();
    double angle = std::numbers::pi;
    for (const auto& p : points) angle = std::min(angle, angleTo(s, p));
    sum += length * std::exp(-std::pow(angle / kAngle, 2));
    total += length;
  }
  return total > 0 ? sum / total : 0;
}

}  // namespace

std::array<Eigen::Vector3d, 3> vanishingPoints(const PlacedShape& placed, const BoxEvidence& evidence) {
  const Eigen::Matrix3d image = evidence.camera.matrix() * cameraFromObject(placed, evidence).linear();
  return {image.col(0), image.col(1), image.col(2)};
}

std::optional<double> edgeAgreement(const PlacedShape& placed, const BoxEvidence& evidence) {
  if (evidence.edges.distance.empty() || placed.shape.kind == ShapeKind::kCylinder) return std::nullopt;
  return kOutlineShare * outlineAgreement(placed, evidence) +
         (1 - kOutlineShare) * segmentAgreement(placed, evidence);
}

}  // namespace roomgraph
