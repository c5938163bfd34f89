// SPDX-License-Identifier: BSD-3-Clause
// Covariance of a placed shape in the ground frame.
#pragma once

#include <Eigen/Core>

#include "roomgraph/proposals/placed_shape.h"

namespace roomgraph {

/// Covariance of (x, y, z, yaw) of a placed shape in the ground frame: m, rad. Along the view the error grows with the
/// square of the distance (disparity). Without supporting depth points it is propagated from the box's bottom and from
/// `ground_tilt_sigma` (rad, paper Eq. 2). A poor fit, a cut box and few points increase it. Calibrated with true
/// boxes; it includes how real objects differ from their models, an error that repeats from frame to frame.
Eigen::Matrix4d covarianceOf(const PlacedShape& placed, const BoxEvidence& evidence,
                             double ground_tilt_sigma);

}  // namespace roomgraph
