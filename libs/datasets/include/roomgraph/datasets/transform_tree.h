// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#pragma once

#include <map>
#include <string>
#include <variant>

#include "roomgraph/core/outcome.h"
#include "roomgraph/observations/trajectory.h"

namespace roomgraph {

/// Named frames joined by fixed or time-varying transforms ("world" - "robot" - "camera"), asked at any time:
/// interpolates on SE(3) and refuses to extrapolate beyond a horizon (method.md sec. 1). Every frame has at
/// most one parent.
class TransformTree {
 public:
  /// Time-varying edges are extrapolated by at most `horizon_s` at both ends.
  explicit TransformTree(double horizon_s = 0) : horizon_s_(horizon_s) {}

  /// Sets or replaces an edge. Throws std::invalid_argument when `child` hangs on another parent already, or
  /// when the edge would close a loop.
  void set(const std::string& parent, const std::string& child, const Pose3& parent_from_child);
  void set(const std::string& parent, const std::string& child, Trajectory parent_from_child);

  /// target_from_source at time t, s; or the reason why it is not known.
  Outcome<Pose3> lookup(const std::string& target, const std::string& source, double t) const;

 private:
  struct Edge {
    std::string parent;
    std::variant<Pose3, Trajectory> parent_from_child;
  };
  void insert(const std::string& child, Edge edge);
  Outcome<Pose3> at(const std::string& child, const Edge& edge, double t) const;
  bool knows(const std::string& frame) const;

  std::map<std::string, Edge> edges_;  ///< by child
  double horizon_s_;
};

}  // namespace roomgraph
