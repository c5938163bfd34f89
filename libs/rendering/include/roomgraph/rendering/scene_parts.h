// SPDX-License-Identifier: BSD-3-Clause
// Parts that make up the scene of a map, and the measures they share.
#pragma once

#include <mrpt/opengl/COpenGLScene.h>

#include <Eigen/Geometry>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "roomgraph/observations/CSemanticMap.h"
#include "roomgraph/observations/object_database.h"

namespace roomgraph {

/// How pictures name a class: "swivel chair" for "swivel_chair".
std::string inWords(std::string class_name);
/// A cell that was measured as free or occupied.
inline bool isKnown(float p_free) {
  return std::abs(p_free - 0.5f) > 0.15f;
}
/// What a picture of the map must show: known cells, objects, path (m, world); a few metres around the origin
/// for an empty map.
Eigen::AlignedBox3d contentBounds(const CSemanticMap& map);
/// Points around everything that a picture must show: the ends of every row of known cells, objects, path. A
/// tighter fit than the corners of the bounding box when the rooms lie askew.
std::vector<Eigen::Vector3d> contentPoints(const CSemanticMap& map);
/// Largest horizontal side of the content, m.
double contentExtent(const CSemanticMap& map);
/// Width of lines that looks the same for small and large maps, m.
double lineWidth(const CSemanticMap& map);
/// Distance of grid lines (1, 2, 5, 10 … m) that gives about ten of them.
double gridStep(double extent_m);
/// Corners of a landmark's footprint in world, counter-clockwise, at its height above ground.
std::vector<Eigen::Vector3d> footprintInWorld(const Landmark& landmark);

void addFloor(const CSemanticMap& map, mrpt::opengl::COpenGLScene& scene);
void addGridLines(const CSemanticMap& map, mrpt::opengl::COpenGLScene& scene);
void addWalls(const CSemanticMap& map, mrpt::opengl::COpenGLScene& scene);
// Lines are `line_width` wide, m; without it as lineWidth() says of the map.
void addPath(const CSemanticMap& map, mrpt::opengl::COpenGLScene& scene,
             std::optional<double> line_width = std::nullopt);
void addLandmarks(const CSemanticMap& map, const ObjectDatabase& database, mrpt::opengl::COpenGLScene& scene,
                  std::optional<double> line_width = std::nullopt);

}  // namespace roomgraph
