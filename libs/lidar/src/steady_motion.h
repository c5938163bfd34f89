// SPDX-License-Identifier: BSD-3-Clause
// SteadyMotion: how a robot goes on that nothing but its scans measures.
#pragma once

#include <Eigen/Core>

#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// Velocity of a robot and how well it is known: a Kalman filter whose state goes on as it was, but for random accelerations.
/// What a scan tells of a step counts by its covariance: a wall along which it slides tells nothing, a few returns on the
/// sides of a door tell a little. Turns are those of the last step, as any wall in view tells them.
class SteadyMotion {
 public:
  SteadyMotion();
  /// The step after dt seconds, in the robot's frame at its beginning.
  Pose2 step(double dt_s) const;
  /// Inverse covariance of its x and y, in that frame; 1/m^2.
  Eigen::Matrix2d stepInformation(double dt_s) const;
  /// `step`: the best estimate from the scan and from stepInformation() together; `scan_per_m2`: what the scan alone told.
  void observe(const Pose2& step, const Eigen::Matrix2d& scan_per_m2, double dt_s);

 private:
  Eigen::Matrix2d predictedCovariance(double dt_s) const;

  Pose2 velocity_;                        ///< per second, robot frame
  Eigen::Matrix2d covariance_m2_per_s2_;  ///< of its x and y
};

}  // namespace roomgraph
