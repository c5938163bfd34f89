// SPDX-License-Identifier: BSD-3-Clause
// FrameGraph: coordinate frames of tf, ways between them, and transforms at a time.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "messages.h"

namespace roomgraph::bags {

/// "parent -> child".
std::string streamOf(const TransformMessage& transform);

/// The frames that tf and tf_static connect. First everything is learned() (which frames there are and which
/// of them move), then the moving ones are followed(): their transforms of the last seconds are kept.
class FrameGraph {
 public:
  /// One step of a way: the transform of an edge or its inverse.
  struct Step {
    std::size_t edge = 0;
    bool inverse = false;
  };
  using Way = std::vector<Step>;

  void learn(const TransformMessage& transform, bool is_static);
  /// Like learn(), for frames known from there; what is older than `keep_s` before the newest of its edge is
  /// forgotten. Returns the edge when it moves.
  std::optional<std::size_t> follow(const TransformMessage& transform, bool is_static, double keep_s);

  bool has(const std::string& frame) const;
  std::vector<std::string> frames() const;
  /// The shortest way that turns coordinates in `from` into those in `to`; empty when both are one.
  std::optional<Way> way(const std::string& to, const std::string& from) const;
  /// Whether no transform on the way changes.
  bool fixed(const Way& way) const;
  /// The edge on the way that came most often; nothing when none moves.
  std::optional<std::size_t> movingEdge(const Way& way) const;
  /// to_from_from at a time: moving edges interpolated. Nothing when one of them has no transforms before and
  /// behind it within a second.
  std::optional<Pose3> at(const Way& way, std::int64_t t_ns) const;
  /// Child frames that have more than one parent.
  const std::vector<std::string>& disputed() const { return disputed_; }

 private:
  struct StampedTransform {
    std::int64_t t_ns = 0;
    Pose3 pose;
    bool holds = false;  ///< of tf_static: until another one comes
  };
  struct Edge {
    std::string parent, child;
    Pose3 first;
    bool moves = false;
    std::size_t count = 0;
    std::deque<StampedTransform> recent;  ///< in order of time
  };
  Edge* find(const TransformMessage& transform);
  static std::optional<Pose3> interpolated(const Edge& edge, std::int64_t t_ns);

  std::vector<Edge> edges_;
  std::vector<std::string> disputed_;
};

}  // namespace roomgraph::bags
