// SPDX-License-Identifier: BSD-3-Clause
// Planar fan of beams from a lidar scan or a slice of a depth image.
#pragma once

#include <vector>

#include "roomgraph/geometry/box.h"
#include "roomgraph/geometry/ground.h"
#include "roomgraph/observations/frame.h"
#include "roomgraph/observations/scan.h"

namespace roomgraph {

/// Free and occupied space measured by one scan or depth image: beams from one point in the plane of the fan (z = 0 of
/// its frame).
struct RangeFan {
  double t = 0;  ///< s
  Pose3 robot_from_fan = Pose3::Identity();
  double angle_min_rad = 0, angle_step_rad = 0;
  std::vector<float> ranges_m;  ///< beam i at angle_min_rad + i * angle_step_rad; > 0: return there; < 0:
                                ///< free up to -range, nothing known beyond; 0: nothing known
};

/// From a lidar scan. A beam without return is free up to at most `no_return_free_m`, if both neighbours have none
/// either: a single one may be a dropout.
RangeFan fanFromScan(const Scan& scan, double no_return_free_m);

/// How a level scan is cut from a depth image.
struct DepthSlice {
  double min_height_m = 0.1, max_height_m = 1.6;  ///< band above the ground whose nearest point is the return
  double max_range_m = 4.5;                       ///< farther points are not used
  int step_px = 4;                                ///< every n-th pixel in both directions
  double beam_rad = 0.00873;                      ///< width of a beam
};

/// Virtual level scan in the local ground frame below the camera: a beam ends at the nearest point in the
/// band (more exactly the third nearest, as outliers: flying pixels), or else is free up to the farthest
/// floor point. Nothing is known where the image shows what moves by itself: pixels in `moving` are left out.
RangeFan fanFromDepth(const Frame& frame, const Plane& ground, const DepthSlice& slice,
                      const std::vector<Box2>& moving = {});

}  // namespace roomgraph
