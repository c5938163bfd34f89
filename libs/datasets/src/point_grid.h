// SPDX-License-Identifier: BSD-3-Clause
// Coarse grid of 3D points from a depth image.
#pragma once

#include <mrpt/obs/CObservation3DRangeScan.h>

#include <Eigen/Core>
#include <vector>

namespace roomgraph {

/// Points of a depth image on a coarse grid, row by row, in the sensor's frame (x forward, y left, z up), m.
struct PointGrid {
  int columns = 0;
  std::vector<Eigen::Vector3d> points;  ///< zero where nothing was measured
};

/// The images must be loaded; empty without depth or without intrinsics that fit.
PointGrid pointGrid(const mrpt::obs::CObservation3DRangeScan& observation);

}  // namespace roomgraph
