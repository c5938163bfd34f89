// SPDX-License-Identifier: BSD-3-Clause
// Filter of length, turn and drift errors of wheels.
#include "roomgraph/estimation/wheel_calibration.h"

#include <cmath>

namespace roomgraph {
namespace {

// Of robots whose wheels nobody calibrated.
constexpr double kUsualLength = 0.04, kUsualTurn = 0.04, kUsualTurnPerM_rad = 0.015;
// What single movements err by beside that grows with their square root.
constexpr double kLengthNoise = 0.03, kTurnNoise = 0.03, kTurnNoisePerM_rad = 0.01;
constexpr double kLeast_m = 0.002, kLeast_rad = 0.002;
constexpr double kDrives_m = 0.1, kTurns_rad = 0.1;  // by wheels: what is less is rest and jitter
constexpr double kSlipWidth = 3;  // standard deviations: beyond it is a slip, or the other source was misled

// Along the arc of a robot on wheels. A sensor that sits beside where it is said to be moves across it in turns.
Eigen::Vector2d aheadOf(const Pose2& movement) { return {std::cos(movement.yaw / 2), std::sin(movement.yaw / 2)}; }

}  // namespace

WheelCalibration::WheelCalibration()
    : covariance_(Eigen::Vector3d(kUsualLength, kUsualTurn, kUsualTurnPerM_rad).cwiseAbs2().asDiagonal()) {}

void WheelCalibration::update(const Eigen::RowVector3d& design, double difference, double variance) {
  const double expected = design * covariance_ * design.transpose() + variance;
  const double left = difference - design.dot(errors_);
  const double surprise = 1 + left * left / expected / (kSlipWidth * kSlipWidth);
  const double outweighed = variance * surprise * surprise;
  const Eigen::Vector3d gain = covariance_ * design.transpose() / (design * covariance_ * design.transpose() + outweighed);
  errors_ += gain * left;
  covariance_ -= gain * design * covariance_;
  covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
}

// What wheels report is predicted from what was seen, which has less noise: the other way round noise would make scales smaller.
void WheelCalibration::compare(const Pose2& wheels, const Movement& other) {
  const Pose2 moved = planarPart(other.a_from_b);
  const Eigen::Vector2d ahead = aheadOf(moved);
  const double seen = ahead.dot(Eigen::Vector2d(moved.x, moved.y)), reported = aheadOf(wheels).dot(Eigen::Vector2d(wheels.x, wheels.y));
  const double seen_m2 = ahead.dot(other.covariance.topLeftCorner<2, 2>() * ahead), seen_rad2 = other.covariance(5, 5);
  const bool drives = std::abs(reported) > kDrives_m, turns = std::abs(wheels.yaw) > kTurns_rad;
  if (drives) update({seen, 0, 0}, reported - seen, seen_m2 + kLeast_m * kLeast_m + kLengthNoise * kLengthNoise * std::abs(seen));
  if (drives || turns)
    update({0, moved.yaw, seen}, wrapAngle(wheels.yaw - moved.yaw),
           seen_rad2 + kLeast_rad * kLeast_rad + kTurnNoise * kTurnNoise * std::abs(moved.yaw) +
               kTurnNoisePerM_rad * kTurnNoisePerM_rad * std::abs(seen));
  compared_ += drives || turns;
}

Eigen::Vector3d WheelCalibration::standardDeviations() const { return covariance_.diagonal().cwiseSqrt(); }

}  // namespace roomgraph
