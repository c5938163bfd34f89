// SPDX-License-Identifier: BSD-3-Clause
// Votes of three sensors, differences of two, and medians of directions.
#include "roomgraph/estimation/movement_agreement.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "roomgraph/core/order_statistics.h"

namespace roomgraph {
namespace {

constexpr std::size_t kSensors = kMotionSensors.size();
constexpr double kDiffers = 25, kAgrees = 11.3;  // squared distances of three numbers, in variances; 11.3 holds for 99 %
constexpr double kSharedError_m = 0.01, kSharedError_rad = 0.01;  // of times and of poses on the robot
constexpr double kLeastOff_m = 0.03, kLeastOff_rad = 0.03;
constexpr double kStraight_m = 0.1, kStraight_rad = 0.1;
constexpr std::size_t kLeastWays = 20;

struct Difference {
  Eigen::Vector3d off;  // x, y, yaw
  double squared = 0;   // in variances
};

Difference differenceOf(const Movement& a, const Movement& b) {
  const Pose2 p = planarPart(a.a_from_b), q = planarPart(b.a_from_b);
  Difference out{{p.x - q.x, p.y - q.y, wrapAngle(p.yaw - q.yaw)}};
  const std::array on_floor = {0, 1, 5};
  Eigen::Matrix3d covariance = (a.covariance + b.covariance)(on_floor, on_floor);
  covariance.diagonal() += Eigen::Vector3d(kSharedError_m, kSharedError_m, kSharedError_rad).cwiseAbs2();
  out.squared = out.off.dot(covariance.llt().solve(out.off));
  return out;
}

bool differ(const Difference& by) {
  return by.squared > kDiffers && (by.off.head<2>().norm() > kLeastOff_m || std::abs(by.off.z()) > kLeastOff_rad);
}

bool isStraight(const Movement& movement) {
  return movement.a_from_b.translation().head<2>().norm() > kStraight_m && std::abs(planarPart(movement.a_from_b).yaw) < kStraight_rad;
}

double angleBetween(const Movement& from, const Movement& to) {
  const Eigen::Vector2d a = from.a_from_b.translation().head<2>(), b = to.a_from_b.translation().head<2>();
  return std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
}

double circularMean(const std::vector<double>& angles) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const double angle : angles) sum += Eigen::Vector2d(std::cos(angle), std::sin(angle));
  return std::atan2(sum.y(), sum.x());
}

}  // namespace

const char* toString(MotionSensor sensor) {
  constexpr std::array kNames = {"lidar", "camera", "wheels"};
  return kNames[static_cast<std::size_t>(sensor)];
}

void MovementAgreement::compare(double from_t, double until_t, const MovementBySensor& seen) {
  for (std::size_t i = 0; i < kSensors; ++i) {
    const auto &one = seen[i], &next = seen[(i + 1) % kSensors];
    if (one && next && isStraight(*one) && isStraight(*next)) turns_[i].push_back(angleBetween(*next, *one));
  }
  for (std::size_t i = 0; i < kSensors; ++i) {
    const std::size_t next = (i + 1) % kSensors;
    if (!seen[i] || !seen[next] || seen[(i + 2) % kSensors]) continue;
    const Difference difference = differenceOf(*seen[i], *seen[next]);
    if (differ(difference))
      add({kMotionSensors[i], from_t, until_t, difference.off.head<2>().norm(), std::abs(difference.off.z()), kMotionSensors[next]});
  }
  if (!seen[0] || !seen[1] || !seen[2]) return;
  for (std::size_t i = 0; i < kSensors; ++i) {
    const Movement &one = *seen[i], &other = *seen[(i + 1) % kSensors], &third = *seen[(i + 2) % kSensors];
    const Difference first = differenceOf(one, other), second = differenceOf(one, third);
    if (differ(first) && differ(second) && differenceOf(other, third).squared < kAgrees)
      add({kMotionSensors[i], from_t, until_t, std::max(first.off.head<2>().norm(), second.off.head<2>().norm()),
           std::max(std::abs(first.off.z()), std::abs(second.off.z()))});
  }
}

void MovementAgreement::add(const Contradiction& now) {
  auto& last = last_[static_cast<std::size_t>(now.sensor) + (now.only_other ? kSensors : 0)];
  if (!last || contradictions_[*last].until_t != now.from_t) {
    last = contradictions_.size();
    contradictions_.push_back(now);
    return;
  }
  Contradiction* known = &contradictions_[*last];
  known->until_t = now.until_t;
  known->off_m = std::max(known->off_m, now.off_m);
  known->off_rad = std::max(known->off_rad, now.off_rad);
}

std::optional<TurnedBy> MovementAgreement::turned(MotionSensor sensor, MotionSensor other) const {
  const auto i = static_cast<std::size_t>(sensor), j = static_cast<std::size_t>(other);
  const bool next = (i + 1) % kSensors == j;
  std::vector<double> turns = turns_[next ? i : j];
  if (turns.size() < kLeastWays) return std::nullopt;
  const double middle = circularMean(turns);  // angles about it do not jump at half a circle
  for (double& turn : turns) turn = wrapAngle(turn - middle);
  // Of a normal distribution the quartiles are 1.349 standard deviations apart, and a median errs by 1.253 / sqrt(n) of one.
  const double median = quantile(turns, 0.5), spread = (quantile(turns, 0.75) - quantile(turns, 0.25)) / 1.349;
  const double turned = wrapAngle(middle + median);
  return TurnedBy{next ? turned : -turned, 1.253 * spread / std::sqrt(static_cast<double>(turns.size()))};
}

}  // namespace roomgraph
