// SPDX-License-Identifier: BSD-3-Clause
// Unary and pairwise potentials of proposals (paper Eq. 4 and 6), and shared features.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "roomgraph/geometry/camera.h"
#include "roomgraph/geometry/projection.h"
#include "roomgraph/observations/feature_track.h"
#include "roomgraph/observations/proposal.h"

namespace roomgraph {

/// Unary potential of a proposal (paper Eq. 4, method.md sec. 3): U = -S (1 - d), with S the agreement of the
/// projected model's size with its box and d the distance of their centres over the box diagonal. In [-1, 0];
/// lower is better.
double unaryPotential(const Proposal& proposal, const Detection& detection);

/// Unary energy alpha U (first sum of Eq. 3), in [-1, 0], scaled by .5 + .5 score: the generator's score
/// decides between shapes that fit the box equally well.
double unaryEnergy(const Proposal& proposal, const Detection& detection);

/// A camera and its pose.
struct Viewpoint {
  PinholeCamera camera;
  Pose3 world_from_camera = Pose3::Identity();
};

/// A proposal in world coordinates, so that later frames can predict its image.
struct ShapeInWorld {
  ObjectShape shape;
  Pose3 world_from_object = Pose3::Identity();
  ProjectedShape projected;  ///< in the frame of the proposal: its area A, px
};
ShapeInWorld shapeInWorld(const Proposal& proposal, const Pose3& world_from_camera);

/// H A(x): the shape's area projected into another view, px; nothing when it is outside that image or behind.
std::optional<ProjectedShape> carriedArea(const ShapeInWorld& shape, const Viewpoint& view);

/// A(x): the shape's whole area inside the image, px. Unlike `visible` it does not end where something nearer
/// hides a side of the box: there all proposals would have the box's own area, whatever their depth.
Box2 areaInImage(const ProjectedShape& projected, const PinholeCamera& camera);

/// Pairwise potential of two proposals (paper Eq. 6): P = 1 - IoU(A(x_t), H A(x_{t-1})), in [0, 1]; of the
/// areas inside the image. 1 when the former proposal is out of view.
double pairwisePotential(const Box2& area, const std::optional<ProjectedShape>& carried);

/// s of Eq. 3: of the features inside either box (ids, ascending), the share inside both. 0 without features.
double featureShare(const std::vector<std::int64_t>& a, const std::vector<std::int64_t>& b);

/// Ids of the features inside a box, ascending, each once.
std::vector<std::int64_t> featuresInside(const std::vector<FeatureTrack>& features, const Box2& box);

/// Ids of the features that lie on the object: inside the detection's box and, where their depth is known,
/// at most `margin_m` outside the proposal's volume (across and up-down alike). Ascending, each once.
std::vector<std::int64_t> featuresOnObject(const std::vector<FeatureTrack>& features, const Box2& box,
                                           const Proposal& proposal, const PinholeCamera& camera,
                                           double margin_m);
/// Margin that all selectors use: about the spread of object sizes and depth noise.
inline constexpr double kFeatureMargin_m = 0.15;

}  // namespace roomgraph
