// SPDX-License-Identifier: BSD-3-Clause
// Planar fan of beams from a lidar scan or a slice of a depth image.
#pragma once

#include <vector>

#include "roomgraph/geometry/ground.h"
#include "roomgraph/observations/frame.h"
#include "roomgraph/observations/scan.h"

namespace roomgraph {

/// What one scan or one depth image says about free and occupied space, kept compactly: beams from one point,
/// in the plane of the fan (z = 0 of its frame).
struct RangeFan {
  double t = 0;  ///< s
  Pose3 robot_from_fan = Pose3::Identity();
  double angle_min_rad = 0, angle_step_rad = 0;
  std::vector<float> ranges_m;  ///< beam i at angle_min_rad + i * angle_step_rad; > 0: return there; < 0:
                                ///< free up to -range, nothing known beyond; 0: nothing known
};

/// A lidar scan. A beam that met nothing within the sensor's range (both neighbours neither, so that a single
/// dropout does not count) is free up to at most `no_return_free_m`.
RangeFan fanFromScan(const Scan& scan, double no_return_free_m);

/// How a depth image is cut into a level scan.
struct DepthSlice {
  double min_height_m = 0.1, max_height_m = 1.6;  ///< band above the ground whose nearest point is the return
  double max_range_m = 4.5;                       ///< farther points are not used
  int step_px = 4;                                ///< every n-th pixel in both directions
  double beam_rad = 0.00873;                      ///< width of a beam
};

/// Virtual level scan in the local ground frame below the camera: a beam is the nearest of the points within
/// the band (the third nearest, so that a lone flying pixel is no wall), or else free up to the farthest
/// floor point.
RangeFan fanFromDepth(const Frame& frame, const Plane& ground, const DepthSlice& slice);

}  // namespace roomgraph
