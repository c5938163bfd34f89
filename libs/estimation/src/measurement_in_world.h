// SPDX-License-Identifier: BSD-3-Clause
// A selected object measurement placed in the world, with its covariance.
#pragma once

#include "roomgraph/association/associator.h"

namespace roomgraph {

/// Places a measurement in the world. Its covariance is given in the ground frame under the camera (x ahead, y left,
/// z up; m, rad) and is rotated by the heading of the camera; the uncertainty of the pose, isotropic on the ground
/// with standard deviation `pose_sigma_m`, is added.
WorldMeasurement measurementInWorld(const ObjectMeasurement& measurement, const PinholeCamera& camera,
                                    const Pose3& world_from_camera, double pose_sigma_m);

}  // namespace roomgraph
