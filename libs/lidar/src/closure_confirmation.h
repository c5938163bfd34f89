// SPDX-License-Identifier: BSD-3-Clause
// Loop closures confirmed by agreement of several.
#pragma once

#include <vector>

#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// A scan b recognised at the place of a scan a.
struct Closure {
  int a = 0, b = 0;  ///< numbers of kept scans
  Pose2 a_from_b;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< of (x, y, yaw), in frame a
  double path_m = 0;  ///< path length between the two scans, as known before the closure
};

/// Where a kept scan stands along the path.
struct WayPoint {
  Pose2 odom_from_robot;
  double path_m = 0;  ///< path length so far
  int segment = 0;
};

/// When several closures found one after the other count as one confirmed return to a place.
struct ConfirmationRule {
  int agreeing = 3;        ///< closures that must agree, the new one included
  double travelled_m = 1;  ///< path length their scans must span: from one spot alone, look-alikes agree too
  double reach_m = 8;  ///< path length over which the matcher's own movement is trusted for the comparison
  double tolerance_m = 0.15, tolerance_rad = 0.05;
  double tolerance_per_m = 0.02;  ///< more tolerance, in m and rad/10, per metre of path compared over
};

/// Holds back closures that would join far-apart ends of the path until enough of them agree with each other.
class ClosureConfirmation {
 public:
  /// Adds one; returns those now confirmed, the new one among them, or nothing.
  std::vector<Closure> add(const Closure& closure, const std::vector<WayPoint>& way,
                           const ConfirmationRule& rule);

 private:
  std::vector<Closure> waiting_;
};

/// Whether two closures describe the same return: each follows from the other and the movements in between.
bool agree(const Closure& first, const Closure& second, const std::vector<WayPoint>& way,
           const ConfirmationRule& rule);

}  // namespace roomgraph
