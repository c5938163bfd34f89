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
constexpr double kSlipWidth = 3;  // standard deviations: beyond it is a slip, or the other source was misled

// Of a movement of the robot: backwards it is negative.
double signedLength(const Pose2& movement) { return std::copysign(std::hypot(movement.x, movement.y), movement.x); }

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
  const bool same_way = wheels.x * moved.x + wheels.y * moved.y >= 0;
  const double reported = signedLength(wheels), seen = std::copysign(std::hypot(moved.x, moved.y), same_way ? reported : -reported);
  const Eigen::Vector2d along = Eigen::Vector2d(moved.x, moved.y).stableNormalized();
  const double seen_m2 = along.dot(other.covariance.topLeftCorner<2, 2>() * along), seen_rad2 = other.covariance(5, 5);
  update({seen, 0, 0}, reported - seen, seen_m2 + kLeast_m * kLeast_m + kLengthNoise * kLengthNoise * std::abs(seen));
  update({0, moved.yaw, seen}, wrapAngle(wheels.yaw - moved.yaw),
         seen_rad2 + kLeast_rad * kLeast_rad + kTurnNoise * kTurnNoise * std::abs(moved.yaw) +
             kTurnNoisePerM_rad * kTurnNoisePerM_rad * std::abs(seen));
  ++compared_;
}

Pose2 WheelCalibration::corrected(const Pose2& wheels) const {
  const auto [length, turn, turn_per_m] = errors();
  const double driven = signedLength(wheels) / (1 + length);
  return {wheels.x / (1 + length), wheels.y / (1 + length), (wheels.yaw - turn_per_m * driven) / (1 + turn)};
}

Eigen::Vector3d WheelCalibration::standardDeviations() const { return covariance_.diagonal().cwiseSqrt(); }

}  // namespace roomgraph
