// SPDX-License-Identifier: BSD-3-Clause
// OrbitCamera: a camera that looks at a point of the world; projection, rays through pixels, fit to content.
#pragma once

#include <mrpt/opengl/CCamera.h>

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "roomgraph/geometry/box.h"
#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// MRPT's camera model in orbit mode, whose own matrices exist only while it renders. World: m, z up; pixels:
/// u right, v down, from the upper left corner of the picture.
struct OrbitCamera {
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< what it looks at
  double distance = 10;                              ///< from the target, m
  double azimuth = -M_PI / 2, elevation = M_PI / 2;  ///< direction from the target to the camera, rad
  double field_of_view = M_PI / 6;                   ///< vertical, rad; perspective only
  bool orthographic = false;                         ///< then the picture's smaller side is half the distance
  int width = 1280, height = 960;                    ///< px

  /// A ray in world, from the camera onwards; of unit direction.
  using Ray = Eigen::ParametrizedLine<double, 3>;

  /// Pixel of a world point; nothing when it is behind the camera.
  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& world) const;
  Ray rayThrough(const Eigen::Vector2d& pixel) const;
  /// Orthographic: pixels per metre.
  double pixelsPerMeter() const;
  /// Moves target (on the floor) and distance until the content's image fills `inner` (px).
  void fit(const std::vector<Eigen::Vector3d>& content, const Box2& inner);
  void applyTo(mrpt::opengl::CCamera& camera) const;

 private:
  struct Axes {
    Eigen::Vector3d forward, right, up, eye;
    double half_width, half_height;  ///< of the picture: m (orthographic), or at depth 1 m
  };
  Axes axes() const;
  void shift(const Eigen::Vector2d& pixels);
};

/// Obliquely from behind the robot, which may be a handheld camera.
OrbitCamera behindRobot(const Pose3& world_from_robot, int width, int height);

}  // namespace roomgraph
