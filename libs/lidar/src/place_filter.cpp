// SPDX-License-Identifier: BSD-3-Clause
// Prediction and update of the filter of places.
#include "place_filter.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace roomgraph {
namespace {

// Standard deviations: of the velocity of a robot of which nothing is known, and of one that others have measured until then; of the
// scale of wheels that nobody calibrated, and of the direction in which they are said to go.
constexpr double kAtFirst_m_s = 0.5, kMeasured_m_s = 0.1, kScale = 0.04, kSkew = 0.02;
constexpr double kChange_m2_s3 = 0.2, kStart_m2_s3 = 1;  // variance by which a velocity changes per second; of a robot that stands
constexpr double kStands_m_s = 0.05;
constexpr double kStep_m = 0.005;                // of a measured step: stamps, digits
constexpr double kStepNoise_m = 0.03;            // the same, of a metre; grows with its root
constexpr double kGoesOn_m = 0.001;              // of a step beside its velocity
constexpr double kMapInView_m = 0.1;             // no place is less sure than that in the map that was made before it
constexpr double kLeastTrust = 1e-4;

// Its columns: what a step gets longer by, and what it gets to its left, per unit of either.
Eigen::Matrix2d alongAndLeft(const Pose2& step) {
  Eigen::Matrix2d out;
  out << step.x, -step.y, step.y, step.x;
  return out;
}

}  // namespace

Pose2 PlaceFilter::corrected(const Pose2& measured) const {
  const Eigen::Vector2d more = alongAndLeft(measured) * missing_;
  return {measured.x + more.x(), measured.y + more.y(), measured.yaw};
}

Pose2 PlaceFilter::steadyStep(double dt_s) const { return {velocity_.x * dt_s, velocity_.y * dt_s, velocity_.yaw * dt_s}; }

// What is known of one kind of error tells nothing of the other.
void PlaceFilter::beginErrors(bool measured) {
  if (measured_ == measured) return;
  const double velocity_m_s = measured_ ? kMeasured_m_s : kAtFirst_m_s;
  measured_ = measured;
  const Eigen::Vector2d sigma = measured ? Eigen::Vector2d(kScale, kSkew) : Eigen::Vector2d::Constant(velocity_m_s);
  errors_ = sigma.cwiseAbs2().asDiagonal();
  both_.setZero();
}

void PlaceFilter::predict(const std::optional<Pose2>& measured, double dt_s, double yaw) {
  beginErrors(measured.has_value());
  predicted_ = measured ? corrected(*measured) : steadyStep(dt_s);
  dt_s_ = dt_s;
  yaw_ = yaw;
  Eigen::Matrix2d by_error = dt_s * Eigen::Matrix2d::Identity();
  double noise_m2 = kGoesOn_m * kGoesOn_m;
  if (measured) {
    by_error = alongAndLeft(*measured);
    noise_m2 = kStep_m * kStep_m + kStepNoise_m * kStepNoise_m * std::hypot(measured->x, measured->y);
  } else {
    const bool stands = std::hypot(velocity_.x, velocity_.y) < kStands_m_s;
    errors_ += (stands ? kStart_m2_s3 : kChange_m2_s3) * dt_s * Eigen::Matrix2d::Identity();
  }
  by_error = Eigen::Rotation2Dd(yaw) * by_error;
  const Eigen::Matrix2d shared = both_ * by_error.transpose();
  place_ += shared + shared.transpose() + by_error * errors_ * by_error.transpose() + noise_m2 * Eigen::Matrix2d::Identity();
  both_ += by_error * errors_;
}

void PlaceFilter::update(const Pose2& step, const Eigen::Matrix2d& scan_per_m2, double trust) {
  place_ /= std::clamp(trust, kLeastTrust, 1.0);
  const Eigen::Matrix2d before = place_.inverse();
  const Eigen::Matrix2d after = (before + scan_per_m2).inverse();
  const Eigen::Matrix2d gain = both_.transpose() * before;
  const Eigen::Vector2d shift = Eigen::Rotation2Dd(yaw_) * Eigen::Vector2d(step.x - predicted_.x, step.y - predicted_.y);
  const Eigen::Vector2d learnt = gain * shift;
  errors_ -= gain * (place_ - after) * gain.transpose();
  const Eigen::Matrix2d capped = (after.inverse() + Eigen::Matrix2d::Identity() / (kMapInView_m * kMapInView_m)).inverse();
  both_ = capped * before * both_;
  place_ = capped;
  velocity_ = {step.x / dt_s_, step.y / dt_s_, step.yaw / dt_s_};
  if (*measured_) {
    missing_ += learnt;
  } else {
    velocity_.x = predicted_.x / dt_s_ + learnt.x();
    velocity_.y = predicted_.y / dt_s_ + learnt.y();
  }
}

}  // namespace roomgraph
