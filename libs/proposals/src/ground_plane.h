// SPDX-License-Identifier: BSD-3-Clause
// Ground plane detection in a depth image.
#pragma once

#include <optional>

#include "roomgraph/core/outcome.h"
#include "roomgraph/observations/frame.h"
#include "roomgraph/observations/proposal.h"

namespace roomgraph {

/// Bounds of the ground plane search (method.md sec. 1.2).
struct GroundSearch {
  double max_angle_error_rad = 0.10;  ///< against the expected normal
  double max_height_error_m = 0.12;  ///< against the expected camera height
  double max_tilt_rad = 0.87;         ///< normal against the image's up direction, without an expected plane
  double min_camera_height_m = 0.25;  ///< without an expected plane: a nearer one is no floor
  double max_camera_height_m = 2.5;
  double max_range_m = 5.0;       ///< depth beyond is not used
  double max_below_ratio = 0.04;  ///< share of all points that may lie below the floor
  int min_points = 120;           ///< sampled floor points
};

/// The floor in the depth image, normal up, camera frame; or why there is none. With an expected plane only planes near
/// it are considered; without, the largest plane below the camera with (nearly) no points below it, so that a desk
/// larger than the visible floor is not taken for it. Fixed random numbers: the same image gives the same plane.
Outcome<GroundEstimate> findGround(const Frame& frame, const std::optional<Plane>& expected,
                                   const GroundSearch& search = {});

}  // namespace roomgraph
