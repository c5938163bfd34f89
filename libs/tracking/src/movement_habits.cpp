// SPDX-License-Identifier: BSD-3-Clause
// Usual sizes of what left the arc in the latest movements.
#include "movement_habits.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "roomgraph/core/order_statistics.h"

namespace roomgraph::tracking {
namespace {

constexpr std::size_t kLeast = 12, kMost = 60;  // movements
constexpr double kRare = 0.05;                  // m, rad: scatter of what is not expected to go on
constexpr double kShare = 0.85, kSigmasOfShare = 1.4395;  // of normal errors so many are within so many standard deviations
constexpr double kFarthestTurn_rad = 1.5;       // of an arc whose chord says how it lies

double sidewaysOnArc(double ahead_m, double yaw_rad) {
  return ahead_m * std::tan(std::clamp(yaw_rad, -kFarthestTurn_rad, kFarthestTurn_rad) / 2);
}

}  // namespace

void MovementHabits::learn(const Pose3& movement, double seconds) {
  if (!(seconds > 0)) return;
  const Eigen::Vector3d way = movement.translation(), turn = logSO3(movement.linear());
  Vector6d off;
  off << 0, way.y() - sidewaysOnArc(way.x(), turn.z()), way.z(), turn.x(), turn.y(), 0;
  latest_.push_back(off.cwiseAbs() / std::sqrt(seconds));
  if (latest_.size() > kMost) latest_.pop_front();
}

Vector6d MovementHabits::scatter() const {
  Vector6d out = Vector6d::Zero();
  out[0] = out[5] = std::numeric_limits<double>::infinity();
  if (latest_.size() < kLeast) return out;
  for (const int i : {1, 2, 3, 4}) {
    std::vector<double> sizes;
    for (const Vector6d& off : latest_) sizes.push_back(off[i]);
    out[i] = quantile(std::move(sizes), kShare) / kSigmasOfShare;
  }
  return out;
}

Pose3 MovementHabits::expected(const Pose3& movement) const {
  const Vector6d scatter = this->scatter();
  Eigen::Vector3d way = movement.translation(), turn = logSO3(movement.linear());
  if (scatter[1] < kRare) way.y() = sidewaysOnArc(way.x(), turn.z());
  if (scatter[2] < kRare) way.z() = 0;
  if (scatter[3] < kRare) turn.x() = 0;
  if (scatter[4] < kRare) turn.y() = 0;
  Pose3 out = Pose3::Identity();
  out.linear() = expSO3(turn);
  out.translation() = way;
  return out;
}

}  // namespace roomgraph::tracking
