// SPDX-License-Identifier: BSD-3-Clause
// Coarse grid of 3D points from a depth image.
#pragma once

#include <mrpt/obs/CObservation3DRangeScan.h>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "roomgraph/geometry/camera.h"

namespace roomgraph {

/// Points of a depth image on a coarse grid, row by row, in the sensor's frame (x forward, y left, z up), m.
struct PointGrid {
  int columns = 0;
  std::vector<Eigen::Vector3d> points;  ///< zero where nothing was measured
};

/// Makes grids of a camera's records; remembers the rays of the pixels while the camera stays the same.
class PointGridMaker {
 public:
  /// The images must be loaded; empty without depth or without intrinsics that fit.
  PointGrid make(const mrpt::obs::CObservation3DRangeScan& observation);

 private:
  PinholeCamera camera_;
  cv::Mat rays_;
};

}  // namespace roomgraph
