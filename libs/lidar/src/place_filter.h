// SPDX-License-Identifier: BSD-3-Clause
// PlaceFilter: how well the place of a robot is known before its scan is matched.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// Kalman filter of the place, and of what predictions of it err by all the time: the scale and the direction of movements that others
/// measure, or the velocity of a robot that goes on as it went. A scan counts by its information: a wall along which it slides tells
/// nothing, so that the place gets less sure along it, and the few returns on the sides of a door then tell what they can.
/// Turns are those that are told, or those of the last step, as any wall in view tells them.
class PlaceFilter {
 public:
  /// The step that others measured, in the frame of the robot before it, without what such steps were found to err by.
  Pose2 corrected(const Pose2& measured) const;
  /// The step of a robot that goes on as it went.
  Pose2 steadyStep(double dt_s) const;

  /// A movement: corrected(measured), or without it steadyStep(dt_s), from a place with that yaw in the map.
  void predict(const std::optional<Pose2>& measured, double dt_s, double yaw);
  /// Covariance of the place predicted, in the frame of the map; m^2.
  const Eigen::Matrix2d& covariance() const { return place_; }
  /// The place was found. `step`: the best estimate from the scan and the prediction together, in the frame of the robot before it;
  /// `scan_per_m2`: what the scan alone told, in that of the map; `trust`: the share of the prediction's information that was used.
  void update(const Pose2& step, const Eigen::Matrix2d& scan_per_m2, double trust = 1);

 private:
  void beginErrors(bool measured);

  Eigen::Matrix2d place_ = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d both_ = Eigen::Matrix2d::Zero();    ///< of the place with the errors
  Eigen::Matrix2d errors_ = Eigen::Matrix2d::Zero();  ///< of `missing_` or the velocity
  std::optional<bool> measured_;                      ///< which of them
  Eigen::Vector2d missing_ = Eigen::Vector2d::Zero();  ///< share of a measured step that is missing along it and to its left
  Pose2 velocity_;                                     ///< per second, frame of the robot
  Pose2 predicted_;                                    ///< the last step
  double dt_s_ = 0, yaw_ = 0;
};

}  // namespace roomgraph
