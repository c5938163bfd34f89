// SPDX-License-Identifier: BSD-3-Clause
// What wheel odometry errs by all the time, learnt while other sensors measure the same movements.
#pragma once

#include <Eigen/Core>

#include "roomgraph/estimation/motion.h"

namespace roomgraph {

/// Systematic errors of wheel odometry: of a movement of length l (m, negative backwards) and turn w (rad) wheels report
/// (1 + length) l and (1 + turn) w + turn_per_m l. Radii and the distance of the wheels lead to these (Borenstein and Feng 1996).
struct WheelErrors {
  double length = 0, turn = 0;
  double turn_per_m = 0;  ///< rad/m: the robot does not drive straight when wheels say so
};

/// Kalman filter whose state are the errors, which do not change; a slip is outweighed (Geman and McClure).
class WheelCalibration {
 public:
  WheelCalibration();

  /// The same movement as wheels measured it, as they were read, and by images or scans. Rest says nothing, and turns on the spot say
  /// nothing of lengths.
  void compare(const Pose2& wheels, const Movement& other);

  WheelErrors errors() const { return {errors_[0], errors_[1], errors_[2]}; }
  /// Of length, turn, turn_per_m.
  Eigen::Vector3d standardDeviations() const;
  /// How many movements said something.
  int compared() const { return compared_; }

 private:
  void update(const Eigen::RowVector3d& design, double difference, double variance);

  Eigen::Vector3d errors_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_;
  int compared_ = 0;
};

}  // namespace roomgraph
