// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/datasets/transform_tree.h"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <stdexcept>

namespace roomgraph {

void TransformTree::set(const std::string& parent, const std::string& child, const Pose3& parent_from_child) {
  insert(child, {parent, parent_from_child});
}

void TransformTree::set(const std::string& parent, const std::string& child, Trajectory parent_from_child) {
  insert(child, {parent, std::move(parent_from_child)});
}

void TransformTree::insert(const std::string& child, Edge edge) {
  const auto known = edges_.find(child);
  if (known != edges_.end() && known->second.parent != edge.parent)
    throw std::invalid_argument("frame '" + child + "' hangs on '" + known->second.parent + "' already");
  for (std::string frame = edge.parent;;) {
    if (frame == child)
      throw std::invalid_argument("'" + edge.parent + "' - '" + child + "' would close a loop");
    const auto above = edges_.find(frame);
    if (above == edges_.end()) break;
    frame = above->second.parent;
  }
  edges_.insert_or_assign(child, std::move(edge));
}

bool TransformTree::knows(const std::string& frame) const {
  return edges_.count(frame) > 0 || std::any_of(edges_.begin(), edges_.end(), [&](const auto& entry) {
           return entry.second.parent == frame;
         });
}

Outcome<Pose3> TransformTree::at(const std::string& child, const Edge& edge, double t) const {
  if (const auto* fixed = std::get_if<Pose3>(&edge.parent_from_child)) return *fixed;
  const auto& trajectory = std::get<Trajectory>(edge.parent_from_child);
  const std::string name = "'" + edge.parent + "' from '" + child + "': ";
  if (trajectory.empty()) return Outcome<Pose3>::failure(name + "no pose is known");
  if (const auto pose = trajectory.at(t, horizon_s_)) return *pose;
  const double early = trajectory.firstTime() - t, late = t - trajectory.lastTime();
  char text[120];
  if (early <= 0 && late <= 0)
    std::snprintf(text, sizeof text, "t = %.6f s is between two segments", t);
  else
    std::snprintf(text, sizeof text, "t = %.6f s is %.3f s %s pose, horizon %.3f s", t, std::max(early, late),
                  early > 0 ? "before the first" : "after the last", horizon_s_);
  return Outcome<Pose3>::failure(name + text);
}

Outcome<Pose3> TransformTree::lookup(const std::string& target, const std::string& source, double t) const {
  for (const auto& frame : {target, source})
    if (!knows(frame)) return Outcome<Pose3>::failure("unknown frame '" + frame + "'");
  // From the source up to the root, then from the target up to the first frame met before. Edges are
  // evaluated only below that frame: what lies above it need not be known at t.
  std::map<std::string, int> above_source;
  for (std::string frame = source;;) {
    above_source.emplace(frame, static_cast<int>(above_source.size()));
    const auto edge = edges_.find(frame);
    if (edge == edges_.end()) break;
    frame = edge->second.parent;
  }
  std::string common = target;
  while (above_source.count(common) == 0) {
    const auto edge = edges_.find(common);
    if (edge == edges_.end())
      return Outcome<Pose3>::failure("'" + target + "' and '" + source + "' are not connected");
    common = edge->second.parent;
  }
  const auto climb = [&](std::string frame) -> Outcome<Pose3> {
    Pose3 pose = Pose3::Identity();
    while (frame != common) {
      const Edge& edge = edges_.at(frame);
      const auto step = at(frame, edge, t);
      if (!step) return step;
      pose = *step * pose;
      frame = edge.parent;
    }
    return pose;
  };
  const auto common_from_source = climb(source), common_from_target = climb(target);
  if (!common_from_source) return common_from_source;
  if (!common_from_target) return common_from_target;
  return Pose3(common_from_target->inverse() * *common_from_source);
}

}  // namespace roomgraph
