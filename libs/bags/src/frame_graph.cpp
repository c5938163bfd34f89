// SPDX-License-Identifier: BSD-3-Clause
// Breadth-first search over transforms, and their interpolation.
#include "frame_graph.h"

#include <algorithm>
#include <map>
#include <set>

namespace roomgraph::bags {
namespace {

constexpr double kSecondNs = 1e9;

bool differs(const Pose3& a, const Pose3& b) {
  constexpr double kLeast = 1e-6;  // m and rad: what is published again and again comes with the same numbers
  return (a.translation() - b.translation()).norm() > kLeast || rotationAngle(a.inverse() * b) > kLeast;
}

}  // namespace

std::string streamOf(const TransformMessage& transform) {
  return transform.header.frame + " -> " + transform.child_frame;
}

FrameGraph::Edge* FrameGraph::find(const TransformMessage& transform) {
  for (auto& edge : edges_)
    if (edge.child == transform.child_frame && edge.parent == transform.header.frame) return &edge;
  return nullptr;
}

void FrameGraph::learn(const TransformMessage& transform, bool is_static) {
  if (transform.child_frame == transform.header.frame) return;
  Edge* edge = find(transform);
  if (!edge) {
    const auto& child = transform.child_frame;
    const bool second =
        std::any_of(edges_.begin(), edges_.end(), [&](const Edge& e) { return e.child == child; });
    if (second && std::find(disputed_.begin(), disputed_.end(), child) == disputed_.end())
      disputed_.push_back(child);
    edges_.push_back({transform.header.frame, child, transform.parent_from_child, false, 0, {}});
    edge = &edges_.back();
  }
  ++edge->count;
  if (!is_static && !edge->moves) edge->moves = differs(edge->first, transform.parent_from_child);
}

std::optional<std::size_t> FrameGraph::follow(const TransformMessage& transform, bool is_static,
                                              double keep_s) {
  Edge* edge = find(transform);
  if (!edge || !edge->moves) return std::nullopt;
  auto& recent = edge->recent;
  const std::int64_t t = transform.header.stamp_ns;
  const auto place =
      std::upper_bound(recent.begin(), recent.end(), t,
                       [](std::int64_t time, const StampedTransform& other) { return time < other.t_ns; });
  if (place != recent.begin() && std::prev(place)->t_ns == t) return std::nullopt;  // published twice
  recent.insert(place, {t, transform.parent_from_child, is_static});
  while (static_cast<double>(recent.back().t_ns - recent.front().t_ns) > keep_s * kSecondNs)
    recent.pop_front();
  return static_cast<std::size_t>(edge - edges_.data());
}

bool FrameGraph::has(const std::string& frame) const {
  return std::any_of(edges_.begin(), edges_.end(),
                     [&](const Edge& edge) { return edge.parent == frame || edge.child == frame; });
}

std::vector<std::string> FrameGraph::frames() const {
  std::set<std::string> names;
  for (const auto& edge : edges_) names.insert({edge.parent, edge.child});
  return {names.begin(), names.end()};
}

std::optional<FrameGraph::Way> FrameGraph::way(const std::string& to, const std::string& from) const {
  std::map<std::string, Way> reached{{from, {}}};
  std::deque<std::string> open{from};
  while (!open.empty() && !reached.contains(to)) {
    const std::string frame = open.front();
    open.pop_front();
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      const Edge& edge = edges_[i];
      const bool up = edge.child == frame;
      if (!up && edge.parent != frame) continue;
      Way way{{i, !up}};
      way.insert(way.end(), reached[frame].begin(), reached[frame].end());
      if (const auto& next = up ? edge.parent : edge.child; reached.emplace(next, std::move(way)).second)
        open.push_back(next);
    }
  }
  const auto found = reached.find(to);
  if (found == reached.end()) return std::nullopt;
  return found->second;
}

bool FrameGraph::fixed(const Way& way) const {
  return std::none_of(way.begin(), way.end(), [&](const Step& step) { return edges_[step.edge].moves; });
}

std::optional<std::size_t> FrameGraph::movingEdge(const Way& way) const {
  std::optional<std::size_t> most;
  for (const auto& step : way)
    if (edges_[step.edge].moves && (!most || edges_[step.edge].count > edges_[*most].count)) most = step.edge;
  return most;
}

std::optional<Pose3> FrameGraph::interpolated(const Edge& edge, std::int64_t t_ns) {
  const auto& recent = edge.recent;
  const auto after =
      std::lower_bound(recent.begin(), recent.end(), t_ns,
                       [](const StampedTransform& other, std::int64_t time) { return other.t_ns < time; });
  if (after != recent.end() && after->t_ns == t_ns) return after->pose;
  if (after == recent.begin()) return std::nullopt;
  const auto& before = *std::prev(after);
  if (before.holds) return before.pose;
  if (after == recent.end()) return std::nullopt;
  const auto span = static_cast<double>(after->t_ns - before.t_ns);
  if (span > kSecondNs) return std::nullopt;
  return interpolate(before.pose, after->pose, static_cast<double>(t_ns - before.t_ns) / span);
}

std::optional<Pose3> FrameGraph::at(const Way& way, std::int64_t t_ns) const {
  Pose3 pose = Pose3::Identity();
  for (const auto& step : way) {
    const Edge& edge = edges_[step.edge];
    const auto parent_from_child = edge.moves ? interpolated(edge, t_ns) : edge.first;
    if (!parent_from_child) return std::nullopt;
    pose = pose * (step.inverse ? parent_from_child->inverse() : *parent_from_child);
  }
  return normalized(pose);
}

}  // namespace roomgraph::bags
