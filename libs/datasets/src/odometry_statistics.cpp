// SPDX-License-Identifier: BSD-3-Clause
// Steps between odometry readings against what a robot in a room can do.
#include "odometry_statistics.h"

#include <algorithm>
#include <cmath>

namespace roomgraph {
namespace {

// Faster than any robot indoors, and farther than what readings that come in bursts make of a usual speed.
constexpr double kFastest_m_s = 3, kLeastJump_m = 0.25;
constexpr double kFastestTurn_rad_s = 6, kLeastJump_rad = 0.5;

}  // namespace

void OdometryStatistics::add(std::optional<double> t, const Pose2& pose) {
  const Pose2 before = last_.value_or(pose);
  const double way = std::hypot(pose.x - before.x, pose.y - before.y);
  const double turn = std::abs(wrapAngle(pose.yaw - before.yaw));
  summary_.path_length_m += way;
  summary_.turn_rad += turn;
  last_ = pose;
  if (!t) return;
  if (last_t_ && *t >= *last_t_) {
    const double dt = *t - *last_t_;
    const bool jump = (way > kLeastJump_m && way > kFastest_m_s * dt) ||
                      (turn > kLeastJump_rad && turn > kFastestTurn_rad_s * dt);
    if (jump && summary_.jumps++ == 0) summary_.first_jump_time = *last_t_;
    if (jump) summary_.largest_jump_m = std::max(summary_.largest_jump_m, way);
    if (jump) summary_.largest_jump_rad = std::max(summary_.largest_jump_rad, turn);
  }
  const bool stands = last_t_ && way == 0 && turn == 0 && *t >= *last_t_;
  if (!stands) {
    if (current_.seconds >= kLeast_s) standstills_.push_back(current_);
    current_ = {*t, 0, 0};
  }
  current_.seconds = *t - current_.from;
  last_t_ = t;
}

std::vector<OdometryStandstill> OdometryStatistics::standstills() const {
  auto all = standstills_;
  if (current_.seconds >= kLeast_s) all.push_back(current_);
  return all;
}

}  // namespace roomgraph
