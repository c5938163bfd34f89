// SPDX-License-Identifier: BSD-3-Clause
// Colour and depth pictures of a simulated scene by off-screen OpenGL; ambient occlusion.
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>

#include "id_raster.h"
#include "scene.h"

namespace roomgraph {

/// Colour pictures of a scene by MRPT's off-screen renderer (EGL, no display). Use from the thread that made
/// it.
class ColorRenderer {
 public:
  /// Throws RunError when there is no off-screen OpenGL.
  ColorRenderer(const Scene& scene, const PinholeCamera& camera);
  ~ColorRenderer();

  /// BGR 8 bit, anti-aliased, lit by one lamp and the surroundings; no shadows. Nothing may be nearer than
  /// `nearest_m` along the optical axis (it would be cut off).
  cv::Mat render(const std::vector<Pose3>& world_from_part, const Pose3& world_from_camera, double nearest_m);
  /// Depth in metres (CV_32F) by the same renderer, at the picture's centres of pixels; 0: nothing. MRPT's
  /// depth has few bits: good to some millimetres when nothing is near. For checking the exact picture.
  cv::Mat renderDepth(const std::vector<Pose3>& world_from_part, const Pose3& world_from_camera,
                      double nearest_m);

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

/// Share of the surroundings' light that reaches every pixel, in (0, 1], CV_32F: corners and what is below
/// furniture are darker (screen-space ambient occlusion after Mittring 2007, on the exact depth).
cv::Mat ambientLight(const cv::Mat& depth, const PinholeCamera& camera);

}  // namespace roomgraph
