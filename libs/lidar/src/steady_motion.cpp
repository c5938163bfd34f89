// SPDX-License-Identifier: BSD-3-Clause
// Prediction and update of the filter of velocities.
#include "steady_motion.h"

#include <Eigen/LU>

namespace roomgraph {
namespace {

constexpr double kAtFirst_m_s = 0.5;   // around rest, of a robot of which nothing is known: standard deviation
constexpr double kChange_m2_s3 = 0.2;  // variance by which a velocity changes per second

}  // namespace

SteadyMotion::SteadyMotion() : covariance_m2_per_s2_(kAtFirst_m_s * kAtFirst_m_s * Eigen::Matrix2d::Identity()) {}

Pose2 SteadyMotion::step(double dt_s) const { return {velocity_.x * dt_s, velocity_.y * dt_s, velocity_.yaw * dt_s}; }

Eigen::Matrix2d SteadyMotion::predictedCovariance(double dt_s) const {
  return covariance_m2_per_s2_ + kChange_m2_s3 * dt_s * Eigen::Matrix2d::Identity();
}

Eigen::Matrix2d SteadyMotion::stepInformation(double dt_s) const { return predictedCovariance(dt_s).inverse() / (dt_s * dt_s); }

void SteadyMotion::observe(const Pose2& step, const Eigen::Matrix2d& scan_per_m2, double dt_s) {
  velocity_ = {step.x / dt_s, step.y / dt_s, step.yaw / dt_s};
  covariance_m2_per_s2_ = (predictedCovariance(dt_s).inverse() + dt_s * dt_s * scan_per_m2).inverse();
}

}  // namespace roomgraph
