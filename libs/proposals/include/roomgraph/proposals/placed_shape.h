// SPDX-License-Identifier: BSD-3-Clause
// Hypothesis of an upright shape at a place, and its projection into the image.
#pragma once

#include <optional>
#include <string>

#include "roomgraph/geometry/projection.h"
#include "roomgraph/proposals/box_evidence.h"

namespace roomgraph {

/// An upright model on the ground, or above it.
struct PlacedShape {
  ObjectShape shape;
  double x = 0, y = 0, yaw = 0;  ///< m, rad, ground frame: bottom centre and direction of the front
  double z = 0;                  ///< m, of the bottom above the ground: 0 for an object that rests on it
  double roll = 0, pitch = 0;    ///< rad, small correction of the local ground's normal, about the camera
  double quality = 0;            ///< how well it explains box, points and usual size, in [0, 1]
  double box_iou = 0;
  BoxSides hidden;  ///< sides of the box that the model was not compared with, as something nearer hides them
  std::optional<double> leg_column;  ///< px where the leg meets the box's bottom line, when it was seen
  bool has_yaw = false;
  bool behind_its_points = true;  ///< false: the depth points are its far side, what is nearer is hidden
  double open_along_m = 0;  ///< standard deviation along the view of what the depth points leave open
  std::optional<Eigen::Matrix3d> covariance;  ///< of (x, y, yaw), m, rad, where the construction gives one
  Eigen::Vector3d size_information = Eigen::Vector3d::Zero();  ///< see Proposal
  Eigen::Vector3d least_size_information = Eigen::Vector3d::Zero();  ///< see Proposal
  PlaceBySize place_by_size = PlaceBySize::Zero();  ///< see Proposal
  bool supported = true;       ///< false: made without the evidence's depth points
  bool other_cluster = false;  ///< made with those of the evidence's other_mask
  std::string source;                         ///< how it was made, for debug pictures
  std::string reason;                         ///< why it was dropped
};

/// The usual size of the class, not placed yet: on the ground or, for an object that does not rest on it, at the height
/// of the lowest depth points.
PlacedShape usualShape(const BoxEvidence& evidence);
/// Whether the height is known: the object rests on the ground, or depth points show where its bottom is.
bool heightKnown(const BoxEvidence& evidence);
/// Pose without the correction of the ground's normal.
Pose3 groundFromObject(const PlacedShape& placed);
/// Pose with that correction.
Pose3 cameraFromObject(const PlacedShape& placed, const BoxEvidence& evidence);
/// Nothing when it is out of view.
std::optional<ProjectedShape> project(const PlacedShape& placed, const BoxEvidence& evidence);
/// Bounds of what is in view of the model: inside the image, and between the sides of the detection's box at which
/// it is hidden; nothing when nothing is.
std::optional<Box2> visibleBounds(const PlacedShape& placed, const BoxEvidence& evidence);
/// IoU of that with the box; 0 when it is out of view.
double boxIou(const PlacedShape& placed, const BoxEvidence& evidence);

}  // namespace roomgraph
