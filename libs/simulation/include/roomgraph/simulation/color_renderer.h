// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>

#include "roomgraph/simulation/id_raster.h"
#include "roomgraph/simulation/scene.h"

namespace roomgraph {

/// Colour pictures of a scene by MRPT's off-screen renderer (EGL, no display). Use from the thread that made
/// it.
class ColorRenderer {
 public:
  /// Throws RunError when there is no off-screen OpenGL.
  ColorRenderer(const Scene& scene, const PinholeCamera& camera);
  ~ColorRenderer();

  /// BGR 8 bit, anti-aliased, lit by one lamp and the surroundings; no shadows.
  cv::Mat render(const std::vector<Pose3>& world_from_part, const Pose3& world_from_camera);
  /// Depth in metres (CV_32F) by the same renderer, at the picture's centres of pixels; good to
  /// some millimetres from 1 m on, nothing nearer. For checking the exact picture.
  cv::Mat renderDepth(const std::vector<Pose3>& world_from_part, const Pose3& world_from_camera);

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

/// Share of the surroundings' light that reaches every pixel, in (0, 1], CV_32F: corners and what is below
/// furniture are darker (screen-space ambient occlusion after Mittring 2007, on the exact depth).
cv::Mat ambientLight(const cv::Mat& depth, const PinholeCamera& camera);

}  // namespace roomgraph
