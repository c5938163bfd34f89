// SPDX-License-Identifier: BSD-3-Clause
// Sums of steps along the key poses, and the shortcuts that loop closures are.
#include "roomgraph/estimation/drift.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "local_maps.h"

namespace roomgraph {
namespace {

constexpr double kContradicts = 5;  // standard deviations

double horizontalVariance(const Matrix6d& covariance) {
  return covariance.topLeftCorner<2, 2>().trace() / 2;
}

std::size_t indexAt(const KeyPoses& poses, double t) {
  return static_cast<std::size_t>(poses.nearest(t).id.value);
}

}  // namespace

// Of the source that knows the place best.
Drift::Variance Drift::ofStep(const KeyPose& a, const KeyPose& b) const {
  std::optional<Variance> least;
  for (const auto* source : {&motion_.lidar, &motion_.visual, &motion_.odometry}) {
    const auto seen = source->between(a.t, b.t, kSourceGap_s);
    if (!seen) continue;
    const bool matched = local_maps_ && source != &motion_.odometry;
    const Matrix6d adds_up = matched ? source->addsUp(seen->covariance) : seen->covariance;
    const Variance own{horizontalVariance(adds_up), adds_up(5, 5)};
    if (!least || own.position_m2 < least->position_m2) least = own;
  }
  if (least) return *least;
  const Matrix6d unknown = unknownMovement(b.t - a.t).covariance;
  return {horizontalVariance(unknown), unknown(5, 5)};
}

void Drift::extend(const KeyPoses& poses) {
  const auto& nodes = poses.nodes();
  while (since_.size() < nodes.size()) {
    const std::size_t n = since_.size();
    const Variance step = n > 0 ? ofStep(nodes[n - 1], nodes[n]) : Variance{};
    for (Variance& since : since_) {
      since.position_m2 += step.position_m2;
      since.yaw_rad2 += step.yaw_rad2;
    }
    since_.push_back({});
    const Variance before = n > 0 ? walked_.back() : Variance{};
    walked_.push_back({before.position_m2 + step.position_m2, before.yaw_rad2 + step.yaw_rad2});
  }
}

void Drift::link(const KeyPoses& poses, const RelativePose& movement) {
  const std::size_t from = indexAt(poses, movement.t_a), last = walked_.size() - 1;
  const auto instead = [&](double walked, double linked, double Variance::*part) {
    const double less = walked - linked;
    if (less <= 0) return;
    for (std::size_t k = 0; k <= from; ++k) since_[k].*part = std::max(since_[k].*part - less, linked);
    for (std::size_t k = from + 1; k <= last; ++k) walked_[k].*part = std::min(walked_[k].*part, walked_[last].*part - less);
  };
  const Variance then = walked_.at(from), now = walked_.at(last);
  instead(now.position_m2 - then.position_m2, horizontalVariance(movement.covariance), &Variance::position_m2);
  instead(now.yaw_rad2 - then.yaw_rad2, movement.covariance(5, 5), &Variance::yaw_rad2);
}

void Drift::close(const KeyPoses& poses, const RelativePose& closure) {
  std::size_t near = indexAt(poses, closure.t_a), far = indexAt(poses, closure.t_b);
  if (since_.at(far).position_m2 < since_.at(near).position_m2) std::swap(near, far);
  const Variance there{since_[near].position_m2 + horizontalVariance(closure.covariance),
                       since_[near].yaw_rad2 + closure.covariance(5, 5)};
  for (std::size_t k = 0; k < since_.size(); ++k) {
    const Variance by_closure{there.position_m2 + std::abs(walked_[k].position_m2 - walked_[far].position_m2),
                              there.yaw_rad2 + std::abs(walked_[k].yaw_rad2 - walked_[far].yaw_rad2)};
    if (by_closure.position_m2 < since_[k].position_m2) since_[k] = by_closure;
  }
}

double Drift::turned(const KeyPoses& poses, double t) const {
  return since_.empty() ? 0 : since_.at(indexAt(poses, t)).yaw_rad2;
}

bool Drift::contradicts(const KeyPoses& poses, const RelativePose& closure) const {
  const Pose3 difference = poses.differenceFrom(closure);
  const auto [then, now] = std::minmax({closure.t_a, closure.t_b});
  const Eigen::Vector2d place = poses.at(now).translation().head<2>();
  const double drifted_m2 = variance(poses, then, place) + horizontalVariance(closure.covariance);
  const double turned_rad2 = turned(poses, then) + closure.covariance(5, 5);
  return difference.translation().norm() > kContradicts * std::sqrt(drifted_m2) ||
         rotationAngle(difference) > kContradicts * std::sqrt(turned_rad2);
}

double Drift::variance(const KeyPoses& poses, double t, const Eigen::Vector2d& place) const {
  if (since_.empty()) return 0;
  const KeyPose& then = poses.nearest(t);
  const Variance& since = since_.at(static_cast<std::size_t>(then.id.value));
  const auto distance = [&place](const KeyPose& from) {
    return (from.world_from_robot.translation().head<2>() - place).norm();
  };
  // A turn anywhere on the way moves the place by its distance from there.
  const double lever = std::max(distance(then), distance(poses.nodes().back()));
  return since.position_m2 + since.yaw_rad2 * lever * lever;
}

}  // namespace roomgraph
