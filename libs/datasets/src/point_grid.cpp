// SPDX-License-Identifier: BSD-3-Clause
// Subsampled back-projection of a range image.
#include "point_grid.h"

#include <algorithm>

#include "depth_registration.h"
#include "frame_conversion.h"

namespace roomgraph {

PointGrid pointGrid(const mrpt::obs::CObservation3DRangeScan& observation) {
  constexpr int kColumns = 80;
  const auto& ranges = observation.rangeImage;
  const int width = static_cast<int>(ranges.cols()), height = static_cast<int>(ranges.rows());
  PointGrid grid;
  if (!observation.hasRangeImage || width == 0 || height == 0) return grid;
  const PinholeCamera camera = cameraForImage(observation.cameraParams, width, height);
  if (!camera.valid()) return grid;
  const cv::Mat rays = pixelRays(camera, distortionOf(observation.cameraParams));
  const int stride = std::max(1, width / kColumns);
  for (int v = stride / 2; v < height; v += stride) {
    grid.columns = 0;
    for (int u = stride / 2; u < width; u += stride, ++grid.columns) {
      const auto ray = rays.at<cv::Vec2f>(v, u);
      const Eigen::Vector3d direction(1, -ray[0], -ray[1]);
      const double range = ranges(v, u) * static_cast<double>(observation.rangeUnits);
      grid.points.emplace_back(range * (observation.range_is_depth ? direction : direction.normalized()));
    }
  }
  return grid;
}

}  // namespace roomgraph
