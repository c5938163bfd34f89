// SPDX-License-Identifier: BSD-3-Clause
// Fit of the camera to the map's content, and projection into pixels.
#include "scene_view.h"

#include <mrpt/opengl/COpenGLViewport.h>

#include <algorithm>

#include "roomgraph/geometry/degree.h"
#include "roomgraph/rendering/scene_parts.h"

namespace roomgraph {

SceneView::SceneView(mrpt::opengl::COpenGLScene& scene, const MapPicture& picture,
                     const SnapshotOptions& options, const Box2& inner) {
  const CSemanticMap& map = picture.whole;
  const auto& path = picture.shown.world_from_robot;
  const double extent = contentExtent(map);
  scene.getViewport()->setViewportClipDistances(0.1f, static_cast<float>(10 * extent + 100));
  camera_.width = options.width;
  camera_.height = options.height;
  camera_.target << contentBounds(map).center().head<2>(), 0;
  camera_.distance = std::max(2 * extent, 5.0);
  if (options.view == SnapshotView::kTop) {
    camera_.orthographic = true;
    camera_.fit(contentPoints(map), inner);
  } else if (options.view == SnapshotView::kOrbit || path.empty()) {
    camera_.azimuth = -65 * kDegree;
    camera_.elevation = 42 * kDegree;
    camera_.fit(contentPoints(map), inner);
  } else {
    camera_ = behindRobot(path.back().pose, options.width, options.height);
  }
  camera_.applyTo(scene.getViewport()->getCamera());
}

}  // namespace roomgraph
