// SPDX-License-Identifier: BSD-3-Clause
// Covariance of a placed shape in the ground frame.
#pragma once

#include <Eigen/Core>

#include "roomgraph/proposals/placed_shape.h"

namespace roomgraph {

/// Covariance of (x, y, z, yaw) of a placed shape in the ground frame: m, rad. Along the view the error grows
/// with the square of the distance (disparity); where no depth point supports the place it comes from the
/// box's bottom, and `ground_tilt_sigma` (rad) carries over to it (paper Eq. 2). A poor fit, a cut box and
/// few points make it larger. Calibrated so that errors with true boxes are covered, the part that comes from
/// shapes that are not quite like their models included: it repeats from frame to frame.
Eigen::Matrix4d covarianceOf(const PlacedShape& placed, const BoxEvidence& evidence,
                             double ground_tilt_sigma);

}  // namespace roomgraph
