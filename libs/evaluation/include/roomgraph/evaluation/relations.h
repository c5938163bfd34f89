// SPDX-License-Identifier: BSD-3-Clause
// Relative-pose metric over verified relations (Kuemmerle et al. 2009).
#pragma once

#include <filesystem>
#include <vector>

#include "roomgraph/evaluation/statistics.h"
#include "roomgraph/observations/trajectory.h"

namespace roomgraph {

/// A verified movement of the robot between two instants (Kümmerle et al., Autonomous Robots 2009).
struct Relation {
  double t1 = 0, t2 = 0;           ///< s
  Pose3 pose = Pose3::Identity();  ///< robot(t1)_from_robot(t2)
};

struct RelationOptions {
  double max_extrapolation_s = 0.02;  ///< largest time of a relation outside the estimate's time span
};

struct RelationErrors {
  ErrorStatistics trans_m, rot_deg;
  int used = 0, missing = 0;  ///< missing: the estimate has no pose at t1 or t2
};

/// Reads lines `t1 t2 x y z roll pitch yaw`; seconds, metres, radians. Throws InputError with file and line.
std::vector<Relation> readRelations(const std::filesystem::path& file);

/// Error of each relation: relation^-1 * (x1^-1 * x2), with the estimated robot poses x1, x2 interpolated at
/// t1, t2.
RelationErrors evaluateRelations(const std::vector<Relation>& relations, const Trajectory& estimate,
                                 const RelationOptions& options = {});

}  // namespace roomgraph
