// SPDX-License-Identifier: BSD-3-Clause
// Objects of a scene that pictures of finished maps do not have: key poses, closures, covariances, scans,
// frames.
#pragma once

#include <mrpt/opengl/COpenGLScene.h>

#include <vector>

#include "roomgraph/observations/CSemanticMap.h"
#include "roomgraph/rendering/palette.h"
#include "roomgraph/viewer/view_state.h"

namespace roomgraph {

using mrpt::opengl::COpenGLScene;

// Sizes in metres, in world.
void addPoints(const std::vector<Eigen::Vector3f>& points, double size, const palette::TColor& color,
               COpenGLScene& scene);
/// Edges of a standing object's box or cylinder.
void addFrame(const ObjectShape& shape, const Pose3& world_from_object, double width,
              const palette::TColor& color, COpenGLScene& scene);
void addKeyPoses(const std::vector<StampedPose>& poses, bool planar, double size,
                 const palette::TColor& color, COpenGLScene& scene);
/// Straight lines between the places on the map's path at the two times; those outside of its time are left
/// out.
void addClosures(const std::vector<ShownClosure>& closures, const CSemanticMap& map, double width,
                 const palette::TColor& color, COpenGLScene& scene);
/// Ellipse of 95 % of the place (x, y), on the floor.
void addCovariance(const Landmark& landmark, double width, const palette::TColor& color, COpenGLScene& scene);
/// Class and id above the object.
void addName(const Landmark& landmark, COpenGLScene& scene);

/// Points of the ellipse that holds 95 % of a normal distribution.
std::vector<Eigen::Vector2d> ellipse95(const Eigen::Vector2d& mean, const Eigen::Matrix2d& covariance,
                                       int sides);

}  // namespace roomgraph
