// SPDX-License-Identifier: BSD-3-Clause
// Coloured triangles, ribbons and discs gathered into one OpenGL object.
#pragma once

#include <mrpt/opengl/CSetOfTriangles.h>

#include <Eigen/Core>
#include <vector>

#include "roomgraph/rendering/palette.h"

namespace roomgraph {

/// Collects unlit coloured triangles into one object of a scene. Lines are drawn as ribbons, because the
/// width of OpenGL's own lines depends on the driver.
class TriangleSet {
 public:
  void triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                const palette::TColor& color);
  /// Convex, corners in order.
  void polygon(const std::vector<Eigen::Vector3d>& corners, const palette::TColor& color);
  /// Flat strip between two points, `width` m wide, horizontal across.
  void ribbon(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double width,
              const palette::TColor& color);
  /// Closed line along a polygon's corners, with round joints.
  void outline(const std::vector<Eigen::Vector3d>& corners, double width, const palette::TColor& color);
  void disc(const Eigen::Vector3d& center, double radius, const palette::TColor& color, int sides = 12);

  /// The object with everything added so far.
  mrpt::opengl::CSetOfTriangles::Ptr object(const std::string& name) const;

 private:
  mrpt::opengl::CSetOfTriangles::Ptr triangles_ = mrpt::opengl::CSetOfTriangles::Create();
};

}  // namespace roomgraph
