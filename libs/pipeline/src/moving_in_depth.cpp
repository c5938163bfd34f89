// SPDX-License-Identifier: BSD-3-Clause
// Slices of depth images as level scans of the memory of free space.
#include "moving_in_depth.h"

#include <algorithm>

namespace roomgraph {
namespace {

constexpr double kMostShare = 0.6;  // somebody near fills half of a camera's view; a lidar sees all around them

FreeSpaceOptions optionsOfDepth() {
  FreeSpaceOptions options;
  options.max_share = kMostShare;
  return options;
}

}  // namespace

MovingInDepth::MovingInDepth() : memory_(optionsOfDepth()) {}

int MovingInDepth::leaveOut(RangeFan& slice, const Pose3& odom_from_robot, int segment) {
  const Pose3 odom_from_fan = odom_from_robot * slice.robot_from_fan;
  if (segment_ != segment) {
    segment_ = segment;
    level_from_odom_ = odom_from_fan.inverse();
    memory_.clear();
  }
  Scan scan;
  scan.t = slice.t;
  scan.angle_min_rad = slice.angle_min_rad;
  scan.angle_step_rad = slice.angle_step_rad;
  scan.ranges_m = slice.ranges_m;
  std::vector<float> free_m;
  for (const float range : slice.ranges_m) {
    scan.valid.push_back(range > 0);
    free_m.push_back(std::max(0.F, -range));
  }
  const auto moving = memory_.observe(scan, planarPart(level_from_odom_ * odom_from_fan), 0, free_m);
  for (const std::size_t beam : moving) slice.ranges_m[beam] = 0;
  return static_cast<int>(moving.size());
}

}  // namespace roomgraph
