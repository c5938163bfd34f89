// SPDX-License-Identifier: BSD-3-Clause
// Loop closures confirmed by agreement of several.
#pragma once

#include <functional>
#include <vector>

#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// Loop closure: scan b was matched to the submap around scan a.
struct Closure {
  int a = 0, b = 0;  ///< numbers of kept scans
  Pose2 a_from_b;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< of (x, y, yaw), in frame a
  double path_m = 0;  ///< path length between the two before this closure; drift is taken to grow with it
  double score = 0;   ///< mean occupancy at the returns
  bool in_corridor = false;  ///< nearly all surfaces face one way or its opposite
};

/// Pose of a kept scan in odometry, and its position along the trajectory.
struct WayPoint {
  Pose2 odom_from_robot;
  double path_m = 0;  ///< path length from the start
  int segment = 0;
};

/// When several consistent closures together count as a confirmed loop.
struct ConfirmationRule {
  int agreeing = 3;        ///< closures that must agree, the new one included
  double travelled_m = 1;  ///< path length their scans must span: from a single pose aliased places agree
  double reach_m = 8;      ///< path length over which the odometry is trusted for the consistency check
  double tolerance_m = 0.15, tolerance_rad = 0.05;
  double tolerance_per_m = 0.02;  ///< additional tolerance, m and rad/10, per metre of path between the compared scans
};

/// Pairwise consistency check: holds back loop closures after a long path until enough of them agree with
/// each other, and tells of those that contradict what was accepted.
class ClosureConfirmation {
 public:
  using HaveRival = std::function<bool(const std::vector<Closure>& agreeing)>;
  /// Adds one; returns those now confirmed, the new one first among them, or nothing. `haveRival` is asked last, of the new one and those that
  /// confirm it: whether another place fits them as well. Then the new one is not added, and the others wait on.
  std::vector<Closure> add(const Closure& closure, const std::vector<WayPoint>& way, const ConfirmationRule& rule,
                           const HaveRival& haveRival = {});
  /// It was taken as true, after a long path or a short one. What is out of the rule's reach from it is forgotten.
  void accept(const Closure& closure, const std::vector<WayPoint>& way, const ConfirmationRule& rule);
  /// Whether most of those accepted within the rule's reach say otherwise. Closures over short paths, each expected where the last
  /// one was, would slide along a wall step by step.
  bool contradicts(const Closure& closure, const std::vector<WayPoint>& way, const ConfirmationRule& rule) const;

 private:
  std::vector<Closure> waiting_;
  std::vector<Closure> accepted_;
};

/// Whether two closures are consistent: composed with the odometry between their scans they form the
/// identity, within the rule's tolerance.
bool agree(const Closure& first, const Closure& second, const std::vector<WayPoint>& way,
           const ConfirmationRule& rule);

}  // namespace roomgraph
