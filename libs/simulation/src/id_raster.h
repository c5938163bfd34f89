// SPDX-License-Identifier: BSD-3-Clause
// Exact depth and object image of a simulated scene, with the visibility of every object.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "roomgraph/geometry/camera.h"
#include "scene.h"

namespace roomgraph {

/// How one object appears in one image; pixel boxes are [u0, v0, u1, v1).
struct ObjectView {
  int object = 0;             ///< index of Scene::objects()
  int px = 0;                 ///< visible pixels
  cv::Rect box, full_box;     ///< of the visible pixels; of the whole silhouette, image borders ignored
  double visible = 0;         ///< px / silhouette
  double unoccluded = 0;      ///< px / silhouette inside the image
  double in_frame = 0;        ///< silhouette inside the image / silhouette
  double median_depth_m = 0;  ///< of the visible pixels
};

/// Noise-free depth and object identity at the centre of every pixel.
struct IdImage {
  cv::Mat depth;                  ///< CV_32F, m along the optical axis, 0: nothing
  cv::Mat object;                 ///< CV_16S, index of Scene::objects(), -1: building or nothing
  std::vector<ObjectView> views;  ///< of all objects with a visible pixel, by object
};

/// Rasterises all triangles with a z-buffer. The result does not depend on the number of threads.
IdImage rasterize(const Scene& scene, const std::vector<Pose3>& world_from_part,
                  const Pose3& world_from_camera, const PinholeCamera& camera);

}  // namespace roomgraph
