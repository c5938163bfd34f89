// SPDX-License-Identifier: BSD-3-Clause
// Object measurement transformed into world, with covariance; overlap of two footprints.
#pragma once

#include "roomgraph/geometry/camera.h"
#include "roomgraph/observations/landmark.h"
#include "roomgraph/observations/proposal.h"

namespace roomgraph {

/// A measurement transformed into world with the current estimate of the pose.
struct WorldMeasurement {
  ObjectMeasurement measurement;
  Pose3 world_from_object = Pose3::Identity();
  /// Of (x, y, z, yaw) in world: proposal and pose together.
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Identity();
  PinholeCamera camera = {};  ///< of the image; not valid: boxes are not compared
};

/// Common ground area of two standing shapes over the smaller footprint, in [0, 1]; 0 when one stands on the other, or above it.
double footprintOverlap(const ObjectShape& a, const Pose3& world_from_a, const ObjectShape& b,
                        const Pose3& world_from_b);

}  // namespace roomgraph
