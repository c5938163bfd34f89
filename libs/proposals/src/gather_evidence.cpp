// SPDX-License-Identifier: BSD-3-Clause
// Depth mask, edges, and cut and hidden sides of a detection's box.
#include "gather_evidence.h"

#include <algorithm>
#include <cmath>

#include "depth_clusters.h"
#include "find_edges.h"
#include "roomgraph/core/order_statistics.h"
#include "vertical_faces.h"

namespace roomgraph {
namespace {

constexpr int kExplanations = 2;     // depth masks that are tried
constexpr double kObjectFront = 0.1;  // quantile of the ranges taken for the object's nearest part
// Distance of the line beside the box along which an occluder is searched: px, and a share of the box's extent.
constexpr double kBesideBox_px = 3, kBesideBoxShare = 0.02;
constexpr int kSamples = 24;          // along that line
constexpr double kHidingShare = 0.4;  // of them, nearer than the object: the side is hidden
constexpr double kNearer_m = 0.15;    // what counts as nearer
// What reaches up to the box's bottom side is a table top or the like, not the floor, if it is so high and no
// farther than the object. An object that stands behind it is seen over its edge to a point below its height;
// one that stands on it is not.
constexpr double kRaised_m = 0.3, kNotBehind_m = 0.1, kOverTheEdge_m = 0.02;
constexpr double kObjectBottom = 0.02;  // quantile of the heights taken for the lowest part in view

BoxSides sidesAtBorder(const BoxEvidence& e) {
  const BoxSides inside = sidesInside(e.box, e.camera);
  return {!inside.left, !inside.top, !inside.right, !inside.bottom};
}

// What hides an object: higher above the ground than `height_m`, and nearer than `range_m`.
struct Occluder {
  double height_m, range_m;
};

// Heights of the points of an occluder along the line from a to b (px, just outside the box); none when it
// covers too little of it.
std::vector<double> occluderAlong(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                  const Occluder& occluder, const BoxEvidence& e, const Frame& frame) {
  const Pose3 ground_from_camera = e.camera_from_ground.inverse();
  std::vector<double> heights;
  for (int i = 0; i < kSamples; ++i) {
    const Eigen::Vector2d p = a + (i + 0.5) / kSamples * (b - a);
    const float z = frame.depthAt(p.x(), p.y());
    if (!(z > 0) || !std::isfinite(z)) continue;
    const Eigen::Vector3d q = ground_from_camera * e.camera.backProject(p.x(), p.y(), z);
    if (q.z() > occluder.height_m && q.head<2>().norm() < occluder.range_m) heights.push_back(q.z());
  }
  if (static_cast<double>(heights.size()) < kHidingShare * kSamples) heights.clear();
  return heights;
}

// Whether the object's lower part is behind or below the table whose top has these heights.
bool beyondTheEdge(const DepthMask& object, const std::vector<double>& table) {
  if (table.empty()) return false;
  std::vector<double> heights;
  for (const auto& p : object.points) heights.push_back(p.in_ground.z());
  return quantile(std::move(heights), kObjectBottom) < median(table) - kOverTheEdge_m;
}

// Behind an occluder the object may extend beyond the box's side, as beyond the image border: the side counts as cut.
void markHidden(BoxEvidence& e, const Frame& frame) {
  if (e.mask.points.empty() || !frame.hasDepth()) return;
  std::vector<double> ranges;
  for (const auto& p : e.mask.points) ranges.push_back(p.in_ground.head<2>().norm());
  const double range = quantile(std::move(ranges), kObjectFront);
  const Box2& b = e.box;
  const double du = kBesideBox_px + kBesideBoxShare * b.width(), dv = kBesideBox_px + kBesideBoxShare * b.height();
  const Occluder nearer{kStanding_m, range - kNearer_m}, table{kRaised_m, range + kNotBehind_m};
  const auto along = [&](double u0, double v0, double u1, double v1, const Occluder& occluder) {
    return occluderAlong({u0, v0}, {u1, v1}, occluder, e, frame);
  };
  e.hidden.left = !e.cut.left && !along(b.u_min - du, b.v_min, b.u_min - du, b.v_max, nearer).empty();
  e.hidden.right = !e.cut.right && !along(b.u_max + du, b.v_min, b.u_max + du, b.v_max, nearer).empty();
  e.hidden.top = !e.cut.top && !along(b.u_min, b.v_min - dv, b.u_max, b.v_min - dv, nearer).empty();
  const auto below = [&](const Occluder& occluder) {
    return along(b.u_min, b.v_max + dv, b.u_max, b.v_max + dv, occluder);
  };
  e.hidden.bottom = !e.cut.bottom && (!below(nearer).empty() ||
                                      (e.model->rests_on_ground && beyondTheEdge(e.mask, below(table))));
  e.cut.left |= e.hidden.left;
  e.cut.right |= e.hidden.right;
  e.cut.top |= e.hidden.top;
  e.cut.bottom |= e.hidden.bottom;
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
  if (model.nominal().kind == ShapeKind::kPlanar)
    e.around = sampleAround(frame, e.box, e.camera_from_ground.inverse());
  Surroundings ring;  // none for what is in a wall
  if (model.nominal().kind != ShapeKind::kPlanar)
    ring = sampleRing(frame, e.box, e.camera_from_ground.inverse());
  auto masks = explanations(e.all, ring, e.box, model, frame.camera.fx, kExplanations);
  masks.resize(kExplanations);
  masks[0].valid_ratio = e.all.valid_ratio;
  e.other_mask = std::move(masks[1]);
  return withMask(e, masks[0], frame);
}

// What one sees of a table is its top. Beams pass below a bed, too, but it is seen down to the floor.
bool isSeenAtItsTop(const DepthMask& mask, const ObjectModel& model) {
  constexpr double kTop = 0.75;  // of its height
  const auto high = std::count_if(mask.points.begin(), mask.points.end(),
                                  [&](const auto& point) { return point.in_ground.z() > kTop * model.height_m; });
  return 2 * static_cast<std::size_t>(high) >= mask.points.size();
}

BoxEvidence withMask(const BoxEvidence& evidence, const DepthMask& mask, const Frame& frame) {
  BoxEvidence e = evidence;
  e.mask = mask;
  e.hidden = {};
  if (e.model->nominal().kind == ShapeKind::kCuboid) e.faces = verticalFaces(mask.points);
  e.segments = supportedSegments(e.edges.segments, mask, e.box);
  if (mask.points.empty()) addDistances(e.edges);
  e.cut = sidesAtBorder(e);
  markHidden(e, frame);
  // Of a table that goes on beyond the image, the leg that reaches lowest may be there.
  const bool open = e.model->nominal().kind == ShapeKind::kCuboid && e.model->solid_share == 0;
  if (open && isSeenAtItsTop(mask, *e.model) && (e.cut.left || e.cut.right) && !e.cut.bottom) e.cut.bottom = e.hidden.bottom = true;
  return e;
}

}  // namespace roomgraph
