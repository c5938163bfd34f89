// SPDX-License-Identifier: BSD-3-Clause
// Evidence of a detection, placed shapes, and the generators of hypotheses by kind of shape.
#pragma once

#include <vector>

#include "box_edges.h"
#include "depth_mask.h"
#include "roomgraph/core/order_statistics.h"
#include "roomgraph/geometry/box_sides.h"
#include "roomgraph/observations/object_database.h"
#include "roomgraph/observations/proposal.h"

namespace roomgraph {

/// What a generator knows about one detection.
struct BoxEvidence {
  PinholeCamera camera;
  Plane ground;  ///< camera frame
  Pose3 camera_from_ground = Pose3::Identity();
  Box2 box;
  bool cut_left = false, cut_top = false, cut_right = false,
       cut_bottom = false;  ///< box side at the image border or at a nearer object: the model may go on
  BoxSides hidden;          ///< of these, the sides at a nearer object
  DepthMask mask;           ///< of the object; may be empty
  DepthMask all;            ///< everything in the box
  DepthMask other_mask;     ///< the next best explanation of the box's points; may be empty
  BoxEdges edges;
  std::vector<Segment2> segments;  ///< of the edges, those the mask supports
  double ground_tilt_sigma = 0;    ///< rad, of the ground's normal; 0: it was seen, nothing to correct
  const ObjectModel* model = nullptr;
};

BoxEvidence gatherEvidence(const Frame& frame, const Detection& detection, const ObjectModel& model,
                           const Plane& ground);
/// The same box with other points taken for the object: what hides its sides is looked for anew.
BoxEvidence withMask(const BoxEvidence& evidence, const DepthMask& mask, const Frame& frame);

/// An upright model on the ground.
struct PlacedShape {
  ObjectShape shape;
  double x = 0, y = 0, yaw = 0;  ///< ground frame
  double roll = 0, pitch = 0;    ///< rad, small correction of the local ground's normal, about the camera
  double quality = 0;            ///< how well it explains box, points and usual size, in [0, 1]
  double box_iou = 0;
  std::optional<double> leg_column;  ///< px where the leg meets the box's bottom line, when it was seen
  bool has_yaw = false;
  std::optional<Eigen::Matrix3d> covariance;  ///< of (x, y, yaw), where the construction tells: m, rad
  bool supported = true;                      ///< false: the evidence's depth points do not speak for it
  std::string source;
  std::string reason;  ///< why it was dropped
};

/// On the ground as it was given, without the correction of its normal.
Pose3 groundFromObject(const PlacedShape& placed);
/// With it.
Pose3 cameraFromObject(const PlacedShape& placed, const BoxEvidence& evidence);
std::optional<ProjectedShape> project(const PlacedShape& placed, const BoxEvidence& evidence);
/// IoU of the projected model with the box, both cut by the image border, the model also by hidden box sides;
/// 0 when it is out of view.
double boxIou(const PlacedShape& placed, const BoxEvidence& evidence);
/// Where the middle of the box's bottom side meets the ground (paper Eq. 2), ground frame; nothing when that
/// side is at the image border or above the horizon.
std::optional<Eigen::Vector2d> contactPoint(const BoxEvidence& evidence);
/// Direction of the box's middle on the ground, rad, and the half angle between its sides.
double bearingOf(const BoxEvidence& evidence);
double halfAngleOf(const BoxEvidence& evidence);

/// Generators of method.md sec. 1.A to 1.C: best hypotheses first, at most `max_count`, none with a box IoU
/// below `min_iou`.
struct GeneratorLimits {
  int max_count = 4;
  double min_iou = 0.3;
  std::vector<PlacedShape>* rejected = nullptr;  ///< dropped hypotheses go here, when set
};
/// Best quality first, at most as many as allowed, none like a better one (nearer than `distance` m and
/// turned by less than `angle` rad).
std::vector<PlacedShape> keepBest(std::vector<PlacedShape> all, double distance, double angle,
                                  const GeneratorLimits& limits);
std::vector<PlacedShape> cylinderHypotheses(const BoxEvidence& evidence, const GeneratorLimits& limits = {});
std::vector<PlacedShape> cuboidHypotheses(const BoxEvidence& evidence, const GeneratorLimits& limits = {});
std::vector<PlacedShape> doorHypotheses(const BoxEvidence& evidence, const GeneratorLimits& limits = {});

}  // namespace roomgraph
