// SPDX-License-Identifier: BSD-3-Clause
// Rigid alignment of an estimated trajectory with the true one.
#pragma once

#include <vector>

#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// Two poses of the same instant.
struct PosePair {
  double t = 0;  ///< stamp of the estimate, s
  Pose3 truth = Pose3::Identity(), estimate = Pose3::Identity();
};

/// truth_from_estimate in SE(3) that minimises the squared distances of the positions, without scale (Umeyama
/// 1991, Eq. 40-42). What the positions do not determine (all on one line, or at one point) is taken from the
/// orientations. Identity when there are no pairs.
Pose3 alignSpatial(const std::vector<PosePair>& pairs);

/// The same in the plane: a transform of x, y and yaw. Directions count as points that far from the positions, m; 0: only where
/// positions tell no yaw.
Pose2 alignPlanar(const std::vector<PosePair>& pairs, double lever_m = 0);

/// True when no pose of either side leaves the horizontal plane: constant z, no roll or pitch.
bool isPlanar(const std::vector<PosePair>& pairs);

/// alignPlanar for planar pairs, for which a rotation in space could also mirror the path; else alignSpatial.
Pose3 align(const std::vector<PosePair>& pairs);

}  // namespace roomgraph
