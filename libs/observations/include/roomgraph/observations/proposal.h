// SPDX-License-Identifier: BSD-3-Clause
// Ground estimate, 3D proposals of objects, and selected object measurements.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roomgraph/core/ids.h"
#include "roomgraph/geometry/ground.h"
#include "roomgraph/geometry/projection.h"
#include "roomgraph/observations/detection.h"

namespace roomgraph {

/// Ground plane seen in one frame (method.md sec. 1.2).
struct GroundEstimate {
  Plane plane;                                           ///< camera frame
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();  ///< of (normal, offset)
  bool from_depth = false;                               ///< false: predicted from the extrinsics
};

/// Ground of one frame: as it was seen, or else as it was predicted.
struct FrameGround {
  std::optional<GroundEstimate> estimate;  ///< nothing when it is neither seen nor predicted
  std::string reason;                      ///< why it was not seen; empty when it was
};

/// By how much a place (m) moves for each metre that width, depth and height are larger.
using PlaceBySize = Eigen::Matrix<double, 2, 3>;

/// One hypothesis of an object's shape and place (method.md sec. 1.E).
struct Proposal {
  int detection = -1;  ///< index j of the detection in its frame
  std::string model;   ///< record of the object database
  std::string class_name;
  ObjectShape shape;
  Pose3 camera_from_object = Pose3::Identity();  ///< object frame: bottom centre, x front, z up
  /// Of (x, y, z, yaw) in the ground-aligned camera frame: m, rad. That of the place contains placeSpread(), what is not
  /// known of the size.
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Identity();
  /// Of width, depth and height, 1/m^2: what this image said about each. `shape` is the compromise of that
  /// with the class's usual size.
  Eigen::Vector3d size_information = Eigen::Vector3d::Zero();
  /// Likewise of a part longer than usual whose end is not in view: about the size that it has at least.
  Eigen::Vector3d least_size_information = Eigen::Vector3d::Zero();
  /// Of the place, x forward and y left in the object's frame: the side that was seen stays where it is.
  PlaceBySize place_by_size = PlaceBySize::Zero();
  bool has_yaw = false;             ///< false: yaw is not observable (round, or no direction found)
  ProjectedShape projected;         ///< its `visible` ends where something nearer hides a side of the box
  double score = 0;  ///< initialisation score in [0, 1] (method.md sec. 1.5)
  double box_iou =
      0;  ///< IoU of the projected shape with the detection's box; sides that are cut or hidden count as met
  std::string source;   ///< generator: "depth", "leg line", "vanishing points", …
  std::string reasons;  ///< what the score is made of, for people
};

/// Straight edge in an image, px.
struct Segment2 {
  Eigen::Vector2d a = Eigen::Vector2d::Zero(), b = Eigen::Vector2d::Zero();
};

/// Covariance of the place, x and y, that comes from what is not known of the size, of an object turned by `yaw` whose
/// class's sizes vary by `size_sigma` (m) each, when an image said `size_information` (1/m^2) about each.
Eigen::Matrix2d placeSpread(const PlaceBySize& by_size, double yaw, const Eigen::Vector3d& size_information,
                            const Eigen::Vector3d& size_sigma);

/// How the proposals of one detection came about, for people (debug pictures).
struct ProposalTrace {
  std::vector<Eigen::Vector2d> mask_pixels;  ///< depth samples taken for the object
  std::vector<Segment2> segments;            ///< edges in the box that were used
  std::vector<Proposal> rejected;            ///< hypotheses that were dropped; `reasons` says why
};

/// Everything that stage 1 says about one frame.
struct FrameProposals {
  FrameId frame;
  double t = 0;
  std::vector<Detection> detections;
  std::vector<Proposal> proposals;
  std::optional<GroundEstimate> ground;
  std::string ground_reason;          ///< why the ground plane was not seen
  std::vector<ProposalTrace> traces;  ///< one per detection when asked for, else empty
};

/// Energy of one selected proposal (paper Eq. 3), as it entered the sum.
struct EnergyTerms {
  double unary = 0;       ///< alpha U
  double pairwise = 0;    ///< s (c + 1 - beta) P, with the object's proposal in the frame before
  double high_order = 0;  ///< (1 - beta*) H
};

/// A selected proposal (method.md sec. 3) on its way to association.
struct ObjectMeasurement {
  FrameId frame;
  double t = 0;
  Detection detection;
  Proposal proposal;
  double confidence = 1;  ///< marginal probability of the choice
  EnergyTerms energy;
  TrackId track;    ///< the object as the semantic codes' index maps (gamma) link it over the last frames
  double beta = 1;  ///< likeness of the frame's semantic code to the previous one's (Eq. 5)
  std::vector<std::int64_t> features;  ///< points of tracked features that lie on the object
};

}  // namespace roomgraph
