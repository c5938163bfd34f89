// SPDX-License-Identifier: BSD-3-Clause
// Sums of steps along the key poses, and the shortcuts that loop closures are.
#include "roomgraph/estimation/drift.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "local_maps.h"

namespace roomgraph {
namespace {

constexpr double kContradicts = 5, kTells = 2;  // standard deviations

double horizontalVariance(const Matrix6d& covariance) {
  return covariance.topLeftCorner<2, 2>().trace() / 2;
}

Eigen::Vector2d placeOf(const KeyPose& pose) { return pose.world_from_robot.translation().head<2>(); }

std::size_t indexAt(const KeyPoses& poses, double t) {
  return static_cast<std::size_t>(poses.nearest(t).id.value);
}

}  // namespace

Drift::Spread Drift::Spread::of(double position_m2, double yaw_rad2, const Eigen::Vector2d& pivot) {
  return {position_m2, yaw_rad2, yaw_rad2 * pivot, yaw_rad2 * pivot * pivot.transpose()};
}

Drift::Spread& Drift::Spread::operator+=(const Spread& other) {
  position_m2 += other.position_m2;
  yaw_rad2 += other.yaw_rad2;
  lever_rad2m += other.lever_rad2m;
  lever2_rad2m2 += other.lever2_rad2m2;
  return *this;
}

Drift::Spread& Drift::Spread::operator-=(const Spread& other) {
  return *this += {-other.position_m2, -other.yaw_rad2, -other.lever_rad2m, -other.lever2_rad2m2};
}

double Drift::Spread::about(const Eigen::Vector2d& place) const {
  // A turn moves a place across the line from its pivot: the axes are turned by a right angle, the variances along them are the same.
  const Eigen::Matrix2d moved = lever2_rad2m2 - place * lever_rad2m.transpose() - lever_rad2m * place.transpose() + yaw_rad2 * place * place.transpose();
  return position_m2 + std::max(0.0, Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(moved, Eigen::EigenvaluesOnly).eigenvalues()(1));
}

void Drift::Spread::takeYaw(const Spread& other) {
  yaw_rad2 = other.yaw_rad2;
  lever_rad2m = other.lever_rad2m;
  lever2_rad2m2 = other.lever2_rad2m2;
}

// Of the source that knows the place best.
Drift::Spread Drift::ofStep(const KeyPose& a, const KeyPose& b) const {
  std::optional<std::pair<double, double>> least;
  for (const auto* source : {&motion_.lidar, &motion_.visual, &motion_.odometry}) {
    const auto seen = source->between(a.t, b.t, kSourceGap_s);
    if (!seen) continue;
    const bool matched = local_maps_ && source != &motion_.odometry;
    const Matrix6d adds_up = matched ? source->addsUp(seen->covariance) : seen->covariance;
    const std::pair own{horizontalVariance(adds_up), adds_up(5, 5)};
    if (!least || own.first < least->first) least = own;
  }
  if (!least) {
    const Matrix6d unknown = unknownMovement(b.t - a.t).covariance;
    least = {horizontalVariance(unknown), unknown(5, 5)};
  }
  return Spread::of(least->first, least->second, placeOf(b));
}

void Drift::extend(const KeyPoses& poses) {
  const auto& nodes = poses.nodes();
  while (since_.size() < nodes.size()) {
    const std::size_t n = since_.size();
    const Spread step = n > 0 ? ofStep(nodes[n - 1], nodes[n]) : Spread{};
    for (Spread& since : since_) since += step;
    since_.push_back({});
    walked_.push_back(n > 0 ? walked_.back() : Spread{});
    walked_.back() += step;
  }
}

Drift::Spread Drift::walked(std::size_t from, std::size_t to) const {
  Spread out = walked_[std::max(from, to)];
  return out -= walked_[std::min(from, to)];
}

void Drift::link(const KeyPoses& poses, const RelativePose& movement) {
  const std::size_t from = indexAt(poses, movement.t_a), last = walked_.size() - 1;
  const Spread linked = Spread::of(horizontalVariance(movement.covariance), movement.covariance(5, 5), placeOf(poses.nodes()[last]));
  Spread less = walked(from, last);
  less -= linked;
  if (less.position_m2 <= 0) less.position_m2 = 0;
  if (less.yaw_rad2 <= 0) less.takeYaw({});
  for (std::size_t k = 0; k <= from; ++k) {
    since_[k] -= less;
    if (less.position_m2 > 0) since_[k].position_m2 = std::max(since_[k].position_m2, linked.position_m2);
    if (less.yaw_rad2 > 0 && since_[k].yaw_rad2 < linked.yaw_rad2) since_[k].takeYaw(linked);
  }
  Spread now = walked_[last];
  now -= less;
  for (std::size_t k = from + 1; k <= last; ++k) {
    walked_[k].position_m2 = std::min(walked_[k].position_m2, now.position_m2);
    if (now.yaw_rad2 < walked_[k].yaw_rad2) walked_[k].takeYaw(now);
  }
}

void Drift::close(const KeyPoses& poses, const RelativePose& closure) {
  std::size_t near = indexAt(poses, closure.t_a), far = indexAt(poses, closure.t_b);
  if (since_.at(far).position_m2 < since_.at(near).position_m2) std::swap(near, far);
  Spread there = since_[near];
  there += Spread::of(horizontalVariance(closure.covariance), closure.covariance(5, 5), placeOf(poses.nodes()[far]));
  for (std::size_t k = 0; k < since_.size(); ++k) {
    Spread by_closure = there;
    by_closure += walked(far, k);
    if (by_closure.position_m2 < since_[k].position_m2) since_[k] = by_closure;
  }
}

double Drift::turned(const KeyPoses& poses, double t) const {
  return since_.empty() ? 0 : since_.at(indexAt(poses, t)).yaw_rad2;
}

double Drift::varianceOf(const KeyPoses& poses, const RelativePose& closure) const {
  const auto [then, now] = std::minmax({closure.t_a, closure.t_b});
  return variance(poses, then, poses.at(now).translation().head<2>()) + horizontalVariance(closure.covariance);
}

bool Drift::contradicts(const KeyPoses& poses, const RelativePose& closure) const {
  const Pose3 difference = poses.differenceFrom(closure);
  const double turned_rad2 = turned(poses, std::min(closure.t_a, closure.t_b)) + closure.covariance(5, 5);
  return difference.translation().norm() > kContradicts * std::sqrt(varianceOf(poses, closure)) ||
         rotationAngle(difference) > kContradicts * std::sqrt(turned_rad2);
}

bool Drift::tellsFromRival(const KeyPoses& poses, const RelativePose& closure) const {
  if (closure.rival_m == std::numeric_limits<double>::infinity()) return true;
  const double off_m = poses.differenceFrom(closure).translation().norm();
  return off_m + kTells * std::sqrt(varianceOf(poses, closure)) < closure.rival_m / 2;
}

double Drift::variance(const KeyPoses& poses, double t, const Eigen::Vector2d& place) const {
  return since_.empty() ? 0 : since_.at(indexAt(poses, t)).about(place);
}

}  // namespace roomgraph
