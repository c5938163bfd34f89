// SPDX-License-Identifier: BSD-3-Clause
// Camera of a picture of the map: projection and framing of the content.
#pragma once

#include <mrpt/opengl/COpenGLScene.h>

#include <Eigen/Core>
#include <optional>

#include "map_picture.h"
#include "roomgraph/rendering/orbit_camera.h"
#include "roomgraph/rendering/snapshot.h"

namespace roomgraph {

/// A camera over the scene and where it puts world points in the picture.
class SceneView {
 public:
  /// Camera for `options.view` that shows the map's content inside `inner` (px). Sets it in the scene's
  /// viewport.
  SceneView(mrpt::opengl::COpenGLScene& scene, const MapPicture& picture, const SnapshotOptions& options,
            const Box2& inner);
  /// Pixel (u right, v down) of a world point; nothing when it is behind the camera.
  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& world) const {
    return camera_.project(world);
  }
  bool orthographic() const { return camera_.orthographic; }
  /// Orthographic views: pixels per metre.
  double pixelsPerMeter() const { return camera_.pixelsPerMeter(); }

 private:
  OrbitCamera camera_;
};

}  // namespace roomgraph
