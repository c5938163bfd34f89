// SPDX-License-Identifier: BSD-3-Clause
// Time-ordered trajectory in segments with interpolation, and relative poses between instants.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "roomgraph/core/growing_list.h"
#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// Relative pose between two instants of the robot, found by a front end (loop closing, relocalisation).
struct RelativePose {
  double t_a = 0, t_b = 0;
  Pose3 a_from_b = Pose3::Identity();
  Matrix6d covariance = Matrix6d::Identity();  ///< of (translation, rotation) in frame a: m, rad
  bool planar = false;                         ///< only x, y, yaw were measured
  std::string source;                          ///< "tracking", "lidar", …
  bool link = false;  ///< goes on from one segment to the next, as a movement does: closes no loop
  double rival_m = std::numeric_limits<double>::infinity();  ///< so far from there is another place that fits as well; infinity: none is known
};

/// Poses of one source in its own frame, ordered by time; interpolates between them on SE(3). Copies are cheap (GrowingList).
/// A source that lost track starts a new segment: there is nothing to interpolate between segments.
class Trajectory {
 public:
  /// Throws std::invalid_argument when t does not come after the last one.
  void add(double t, const Pose3& pose, int segment = 0);
  bool empty() const { return poses_.empty(); }
  std::size_t size() const { return poses_.size(); }
  const GrowingList<StampedPose>& poses() const { return poses_; }
  int segment(std::size_t index) const { return segments_[index]; }
  double firstTime() const { return poses_.front().t; }
  double lastTime() const { return poses_.back().t; }

  /// Pose at t; extrapolates with the last velocity by at most `horizon_s` at both ends.
  /// Nothing further out, or between two segments.
  std::optional<Pose3> at(double t, double horizon_s = 0) const;
  /// Movement a_from_b between two instants of one segment.
  std::optional<Pose3> between(double t_a, double t_b, double horizon_s = 0) const;

 private:
  GrowingList<StampedPose> poses_;
  GrowingList<int> segments_;
};

/// Pose at a time; nothing where it is not known.
using PoseAt = std::function<std::optional<Pose3>(double t)>;

}  // namespace roomgraph
