// SPDX-License-Identifier: BSD-3-Clause
// Change of the reference, and sums of covariances along the chain.
#include "dense_chain.h"

#include <Eigen/Geometry>

namespace roomgraph::tracking {
namespace {

constexpr double kKeepsReference = 0.6;  // overlap
// What the residuals do not show: depth bias, registration of the images, things that moved.
constexpr double kFloor_m = 0.01, kFloor_rad = 0.006;
constexpr double kPredicted_m = 0.15, kPredicted_rad = 0.15;

// Of first_from_reference * reference_from_current: a turn of the first part moves the end of the second.
ChainedMovement chained(const ChainedMovement& to_reference, const DenseAlignment& step) {
  const Eigen::Matrix3d turn = to_reference.first_from_current.linear();
  Matrix6d lever = Matrix6d::Identity();
  lever.topRightCorner<3, 3>() =
      Eigen::Matrix3d::Identity().colwise().cross(Eigen::Vector3d(turn * step.reference_from_current.translation()));
  Matrix6d own = rotateCovariance(step.covariance, turn);
  own.diagonal().head<3>().array() += kFloor_m * kFloor_m;
  own.diagonal().tail<3>().array() += kFloor_rad * kFloor_rad;
  return {normalized(to_reference.first_from_current * step.reference_from_current),
          lever * to_reference.covariance * lever.transpose() + own};
}

}  // namespace

void DenseChain::begin(const Frame& frame, const std::vector<Box2>& excluded) {
  begun_ = true, broken_ = false;
  first_ = frame;
  excluded_ = excluded;
  reference_.reset();
  to_reference_ = last_ = {};
}

std::optional<ChainedMovement> DenseChain::follow(const Frame& frame, const std::vector<Box2>& excluded,
                                                  const Pose3& predicted) {
  if (!unbroken()) return std::nullopt;
  if (!reference_) reference_ = std::make_shared<DenseImage>(first_, excluded_);
  const auto current = std::make_shared<const DenseImage>(frame, excluded);
  const DensePrior prior{to_reference_.first_from_current.inverse() * predicted, kPredicted_m, kPredicted_rad};
  const auto step = alignDense(*reference_, *current, prior);
  broken_ = !step;
  if (!step) return std::nullopt;
  last_ = chained(to_reference_, *step);
  if (step->overlap < kKeepsReference) reference_ = current, to_reference_ = last_;
  return last_;
}

}  // namespace roomgraph::tracking
