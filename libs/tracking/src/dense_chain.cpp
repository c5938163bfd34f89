// SPDX-License-Identifier: BSD-3-Clause
// Change of the reference, and sums of covariances along the chain.
#include "dense_chain.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace roomgraph::tracking {
namespace {

constexpr double kKeepsReference = 0.6;  // overlap
// What the residuals do not show: depth bias, registration of the images, things that moved.
constexpr double kFloor_m = 0.01, kFloor_rad = 0.006;
// Changes of the velocity of a robot or a hand.
constexpr double kAcceleration = 0.7, kTurning = 2;  // m/s^2, rad/s^2
constexpr double kLeastStep_m = 0.005, kLeastStep_rad = 0.01;
constexpr double kAnyVelocity = 0.4, kAnyTurn = 0.6;  // m/s, rad/s
constexpr double kCoast_s = 1.5;
constexpr double kPlausible = 4;  // standard deviations of the step: beyond is elsewhere, found by a likeness
// Standard deviations of what was not seen: of a direction in images, and of all, m/s, rad/s.
constexpr double kVelocity = 0.15, kTurn = 0.25, kBlindVelocity = 0.3, kBlindTurn = 0.5;

// Habits are not laws.
constexpr double kHabit = 3, kLeastHabit_m = 0.01, kLeastHabit_rad = 0.005;  // factor; over the square root of a second

// Half the way back along an arc: a turn moves its end sideways by half the way, which is no sideways movement.
Pose3 pivotOf(const CarryingBody& body, const Pose3& step) {
  const double ahead = (body.camera_from_body.inverse() * step * body.camera_from_body).translation().x();
  return body.camera_from_body * Eigen::Translation3d(-ahead / 2, 0, 0);
}

// As much as is known without the body, or as little as it moves in so many seconds.
Vector6d limited(const Vector6d& sigma, const std::optional<CarryingBody>& body, double seconds) {
  if (!body) return sigma;
  const Vector6d habit = kHabit * body->scatter.cwiseMax(sameInAllDirections(kLeastHabit_m, kLeastHabit_rad));
  return sigma.cwiseMin(std::sqrt(seconds) * habit);
}

// How far a turn about the beginning of a way moves its end.
Matrix6d leverOf(const Eigen::Vector3d& way) {
  Matrix6d out = Matrix6d::Identity();
  out.topRightCorner<3, 3>() = Eigen::Matrix3d::Identity().colwise().cross(way);
  return out;
}

// Of first_from_reference * reference_from_current: a turn of the first part moves the end of the second. What is known of a
// step is told about the reference's origin, a movement by its end.
ChainedMovement chained(const ChainedMovement& to_reference, const DenseAlignment& step) {
  const Eigen::Matrix3d turn = to_reference.first_from_current.linear();
  const Matrix6d lever = leverOf(turn * step.reference_from_current.translation());
  const Matrix6d to_end = leverOf(step.reference_from_current.translation());
  Matrix6d own = rotateCovariance(Matrix6d(to_end * step.covariance * to_end.transpose()), turn);
  own.diagonal().head<3>().array() += kFloor_m * kFloor_m;
  own.diagonal().tail<3>().array() += kFloor_rad * kFloor_rad;
  return {true, normalized(to_reference.first_from_current * step.reference_from_current),
          lever * to_reference.covariance * lever.transpose() + own};
}

}  // namespace

void DenseChain::begin(const Frame& frame, const std::vector<Box2>& excluded, bool moving) {
  begun_ = true, broken_ = false, moving_ = moving;
  first_ = frame;
  excluded_ = excluded;
  reference_.reset();
  reference_t_ = last_t_ = seen_t_ = frame.t;
  to_reference_ = seen_ = last_ = {};
}

bool DenseChain::unbroken(double t) const {
  return begun_ && !broken_ && t - seen_t_ <= kCoast_s;
}

std::optional<ChainedMovement> DenseChain::follow(const Frame& frame, const std::vector<Box2>& excluded,
                                                  const Prediction& predicted) {
  broken_ = !unbroken(frame.t);
  if (broken_) return std::nullopt;
  if (!reference_) reference_ = std::make_shared<DenseImage>(first_, excluded_);
  const auto current = std::make_shared<const DenseImage>(frame, excluded);
  const double step = frame.t - last_t_, since = frame.t - reference_t_;
  const bool known = moving_ || predicted.measured;
  const Vector6d sigma = sameInAllDirections(
      known ? std::max(kLeastStep_m, std::min(kAcceleration * step * step, predicted.sigma_m)) : kAnyVelocity * step,
      known ? std::max(kLeastStep_rad, std::min(kTurning * step * step, predicted.sigma_rad)) : kAnyTurn * step);
  const auto& body = predicted.body;
  const auto alignedFrom = [&](const Pose3& first_from_current) {
    const Pose3 expected = to_reference_.first_from_current.inverse() * first_from_current;
    return alignDense(*reference_, *current,
                      {expected, limited(sigma, body, step),
                       limited(sameInAllDirections(kVelocity * since, kTurn * since), body, since),
                       body ? std::optional(pivotOf(*body, expected)) : std::nullopt, kPlausible * sigma[0],
                       kPlausible * sigma[5]});
  };
  last_t_ = frame.t;
  auto found = alignedFrom(predicted.first_from_current);
  if (!found && predicted.otherwise) found = alignedFrom(*predicted.otherwise);
  if (!found) return coast(frame.t, current, predicted);
  last_ = seen_ = chained(to_reference_, *found);
  seen_t_ = frame.t;
  moving_ = true;
  if (found->overlap < kKeepsReference) reference_ = current, reference_t_ = frame.t, to_reference_ = last_;
  return last_;
}

// For a moment the velocity is believed; what comes then is compared with what was seen last on the way.
ChainedMovement DenseChain::coast(double t, const std::shared_ptr<const DenseImage>& image,
                                  const Prediction& predicted) {
  const double unseen = t - seen_t_;
  const auto& body = predicted.body;
  DenseAlignment step{seen_.first_from_current.inverse() * predicted.first_from_current};
  const Vector6d sigma = limited(sameInAllDirections(kBlindVelocity * unseen, kBlindTurn * unseen), body, unseen);
  const Pose3 current_from_axes = body ? pivotOf(*body, step.reference_from_current) : Pose3::Identity();
  const Matrix6d axes = adjoint(step.reference_from_current * current_from_axes);
  step.covariance = axes * Matrix6d(sigma.cwiseAbs2().asDiagonal()) * axes.transpose();
  last_ = to_reference_ = chained(seen_, step);
  last_.seen = false;
  reference_ = image, reference_t_ = t;
  return last_;
}

}  // namespace roomgraph::tracking
