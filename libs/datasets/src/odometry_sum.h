// SPDX-License-Identifier: BSD-3-Clause
// Odometry pose summed up from the increments of action records.
#pragma once

#include <mrpt/obs/CActionCollection.h>

#include <optional>
#include <string>

#include "roomgraph/observations/scan.h"

namespace roomgraph {

/// Increments of action records summed up to a pose in the odometry frame, which is the robot's before the
/// first one.
class OdometrySum {
 public:
  /// Why nothing was added ("no movement of the robot in it", "movement: pose is not finite", …); empty when
  /// all is well.
  std::string add(const mrpt::obs::CActionCollection& actions);
  /// Time of the last action added, s; nothing when it carries none.
  std::optional<double> time() const { return time_; }
  Pose2 pose() const { return planarPart(odom_from_robot_); }

 private:
  Pose3 odom_from_robot_ = Pose3::Identity();
  std::optional<double> time_;
};

/// Time stamp in s; nothing when it is not set.
std::optional<double> toSeconds(const mrpt::Clock::time_point& time);

}  // namespace roomgraph
