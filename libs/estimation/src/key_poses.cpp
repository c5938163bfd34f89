// SPDX-License-Identifier: BSD-3-Clause
// Nearest key pose, and poses blended from both neighbours with the motion in between.
#include "roomgraph/estimation/key_poses.h"

#include <algorithm>
#include <cmath>

namespace roomgraph {
namespace {
constexpr double kHorizon_s = 0.25;  // beyond this no source is extrapolated
}

const KeyPose& KeyPoses::nearest(double t) const {
  const auto after = std::lower_bound(nodes_.begin(), nodes_.end(), t,
                                      [](const KeyPose& node, double time) { return node.t < time; });
  if (after == nodes_.begin()) return nodes_.front();
  if (after == nodes_.end()) return nodes_.back();
  return after->t - t < t - std::prev(after)->t ? *after : *std::prev(after);
}

NodeId KeyPoses::add(double t, const Pose3& world_from_robot) {
  const NodeId id{static_cast<std::int64_t>(nodes_.size())};
  nodes_.push_back({id, t, normalized(world_from_robot)});
  return id;
}

void KeyPoses::set(NodeId id, const Pose3& world_from_robot) {
  nodes_.at(static_cast<std::size_t>(id.value)).world_from_robot = world_from_robot;
}

void KeyPoses::moveFrom(NodeId first, const Pose3& new_from_old) {
  for (auto i = static_cast<std::size_t>(first.value); i < nodes_.size(); ++i)
    nodes_[i].world_from_robot = new_from_old * nodes_[i].world_from_robot;
}

Pose3 KeyPoses::offset(const KeyPose& node, double t) const {
  if (t == node.t) return Pose3::Identity();
  return motion_.movement(node.t, t, kHorizon_s).value_or(Pose3::Identity());
}

Pose3 KeyPoses::at(double t) const {
  const auto after = std::lower_bound(nodes_.begin(), nodes_.end(), t,
                                      [](const KeyPose& node, double time) { return node.t < time; });
  if (after == nodes_.begin()) return nodes_.front().world_from_robot * offset(nodes_.front(), t);
  if (after == nodes_.end()) return nodes_.back().world_from_robot * offset(nodes_.back(), t);
  const KeyPose &a = *std::prev(after), &b = *after;
  const auto sees = [&](const KeyPose& node) { return node.t == t || motion_.movement(node.t, t, kHorizon_s); };
  const Pose3 from_a = a.world_from_robot * offset(a, t), from_b = b.world_from_robot * offset(b, t);
  // Before a gap that nothing covers the pose beyond it says nothing, and the other way round.
  if (const bool by_a = sees(a), by_b = sees(b); by_a != by_b) return by_a ? from_a : from_b;
  return interpolate(from_a, from_b, (t - a.t) / (b.t - a.t));
}

std::optional<Pose3> KeyPoses::between(double t) const {
  const auto after = std::lower_bound(nodes_.begin(), nodes_.end(), t,
                                      [](const KeyPose& node, double time) { return node.t < time; });
  if (after == nodes_.end()) return std::nullopt;
  if (after->t == t) return after->world_from_robot;
  if (after == nodes_.begin()) return std::nullopt;
  const KeyPose& before = *std::prev(after);
  return interpolate(before.world_from_robot, after->world_from_robot, (t - before.t) / (after->t - before.t));
}

Pose3 KeyPoses::differenceFrom(const RelativePose& closure) const {
  return closure.a_from_b.inverse() * (at(closure.t_a).inverse() * at(closure.t_b));
}

Trajectory KeyPoses::trajectory() const {
  Trajectory out;
  for (const auto& node : nodes_) out.add(node.t, node.world_from_robot);
  return out;
}

}  // namespace roomgraph
