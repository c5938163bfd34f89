// SPDX-License-Identifier: BSD-3-Clause
// Flats, cameras and faults of sensors, varied beyond what recordings show.
#pragma once

#include <opencv2/core/mat.hpp>

#include "roomgraph/core/random.h"
#include "roomgraph/simulation/training_set.h"
#include "roomgraph/simulation/world.h"
#include "scene.h"

namespace roomgraph {

/// More chairs and people, other surfaces and colours, and mesh files in place of half of the built shapes
/// that have some. Walking people may pass through furniture.
void varyWorld(World& world, const MeshChoice& meshes, Random& random);

/// Light, range and noise of a camera of the given size, with its field of view.
CameraSpec drawTrainingCamera(cv::Size size, Random& random);

/// A view from near the path, any height from .25 to 1.75 m, leaning up to 35 degrees down and 12 up, rolled
/// a little, every second one at an object; or, one in three, of an object from .8 to 2.2 m, often over a
/// table.
Pose3 drawTrainingView(const Scene& scene, double seconds, Random& random);

/// Depth of some objects, of round patches or of all that is far is lost, and the whole is shifted by up to 2
/// px against the colours. `depth`: CV_16U, mm.
void spoilDepth(cv::Mat& depth, const cv::Mat& object, Random& random);

/// Where an object stands, as a camera sees it.
struct SeenPlace {
  double range_m = 0;  ///< from the camera to the object's middle
  double front_rad =
      0;  ///< about the vertical, from the direction to the camera to the object's front (its x axis)
};
/// Of an object of that height whose origin is at its foot; `camera`: in world.
SeenPlace seenPlace(const Pose3& world_from_object, double height_m, const Eigen::Vector3d& camera);

/// Exposure, white balance, blur and JPEG.
cv::Mat spoilColor(const cv::Mat& color, Random& random);

}  // namespace roomgraph
