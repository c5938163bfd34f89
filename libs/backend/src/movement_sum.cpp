// SPDX-License-Identifier: BSD-3-Clause
// Normal equations of movements between two poses, and the movements of a graph between its bodies.
#include "movement_sum.h"

#include <Eigen/Cholesky>

#include "attached_poses.h"
#include "graph_state.h"
#include "residuals.h"

namespace roomgraph {
namespace {

// What a Cauchy loss of this width leaves of the weight of a residual.
double robustWeight(double squared, double width) {
  return width > 0 ? 1 / (1 + squared / (width * width)) : 1;
}

}  // namespace

// The residual of a movement X against a measurement M near it is that of `near_` against M and that of X against `near_`
// together: in translation exactly, in rotation to the first order.
void MovementSum::add(const BetweenFactor& factor) {
  const BetweenResidual residual(factor);
  const Eigen::Vector3d origin = Eigen::Vector3d::Zero(), place = near_.translation();
  const Eigen::Quaterniond upright = Eigen::Quaterniond::Identity(), turn(near_.linear());
  Vector6d whitened;
  residual(origin.data(), upright.coeffs().data(), place.data(), turn.coeffs().data(), whitened.data());
  const double weight = robustWeight(whitened.squaredNorm(), factor.robust_width);
  information_ += weight * residual.whitening.transpose() * residual.whitening;
  gradient_ += weight * residual.whitening.transpose() * whitened;
  if (!first_) first_ = factor;
  ++count_;
}

BetweenFactor MovementSum::asOne() const {
  if (count_ == 1) return *first_;
  const Matrix6d covariance = information_.inverse();
  const Vector6d best = -covariance * gradient_;
  BetweenFactor out{first_->a, first_->b, near_, covariance, 0};
  const Eigen::Vector3d half = best.tail<3>() / 2;
  const double w = std::sqrt(std::max(0.0, 1 - half.squaredNorm()));
  out.a_from_b.translation() += best.head<3>();
  out.a_from_b.linear() = near_.linear() * Eigen::Quaterniond(w, half.x(), half.y(), half.z()).normalized().toRotationMatrix();
  return out;
}

void FactorGraph::addToSum(const BetweenFactor& factor) {
  const auto told = toldOfBodies(factor, impl_->attached);
  if (!told) return;
  const auto& movement = std::get<BetweenFactor>(*told);
  if (!impl_->bodies.contains(movement.a) || !impl_->bodies.contains(movement.b)) {
    add(factor);
    return;
  }
  const auto [sum, first] = impl_->sums.try_emplace({movement.a, movement.b}, pose(movement.a).inverse() * pose(movement.b));
  sum->second.add(movement);
}

void FactorGraph::addSums() {
  for (const auto& [poses, sum] : impl_->sums) add(sum.asOne());
  impl_->sums.clear();
}

}  // namespace roomgraph
