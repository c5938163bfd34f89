// SPDX-License-Identifier: BSD-3-Clause
// Key poses of the graph and robot poses interpolated between them.
#pragma once

#include <optional>
#include <vector>

#include "roomgraph/backend/factors.h"
#include "roomgraph/estimation/motion.h"
#include "roomgraph/observations/trajectory.h"

namespace roomgraph {

/// One pose of the graph.
struct KeyPose {
  NodeId id;
  double t = 0;
  Pose3 world_from_robot = Pose3::Identity();
};

/// The robot's poses in world: key poses, and between them those of the sources of motion.
class KeyPoses {
 public:
  explicit KeyPoses(const Motion& motion) : motion_(motion) {}
  /// The same key poses, with motion of their own.
  KeyPoses(const KeyPoses& others, const Motion& motion) : motion_(motion), nodes_(others.nodes_) {}

  bool empty() const { return nodes_.empty(); }
  const std::vector<KeyPose>& nodes() const { return nodes_; }
  /// Key pose closest in time; there must be one. The reference holds until the next key pose is added.
  const KeyPose& nearest(double t) const;
  /// There must be one of that id.
  const KeyPose& node(NodeId id) const { return nodes_.at(static_cast<std::size_t>(id.value)); }
  /// Appends; t must come after the last one.
  NodeId add(double t, const Pose3& world_from_robot);
  /// There must be one of that id.
  void set(NodeId id, const Pose3& world_from_robot);
  /// Moves that key pose and all later ones rigidly in world.
  void moveFrom(NodeId first, const Pose3& new_from_old);
  /// Pose at any time, interpolated between the predictions from the key poses before and after; the nearest key pose
  /// when no source of motion covers the time. There must be a key pose.
  Pose3 at(double t) const;
  /// The same by the key poses alone, as trajectory() has it; nothing before the first and after the last.
  std::optional<Pose3> between(double t) const;
  /// Movement from a key pose to a time near it; none when no source of motion covers it.
  Pose3 offset(const KeyPose& node, double t) const;
  /// What the estimate says of a closure's two times beyond the closure itself: identity where they agree.
  Pose3 differenceFrom(const RelativePose& closure) const;
  Trajectory trajectory() const;

 private:
  const Motion& motion_;
  std::vector<KeyPose> nodes_;
};

}  // namespace roomgraph
