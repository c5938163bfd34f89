// SPDX-License-Identifier: BSD-3-Clause
// Split of landmarks by time, constellation match and verification by sensors.
#include "roomgraph/estimation/object_loop_closer.h"

#include <algorithm>
#include <set>

namespace roomgraph {
namespace {

constexpr double kMinExistence = 0.5;  // less probable landmarks must not close loops
constexpr int kMinObservations = 3;
constexpr double kPause_s = 10;       // between two attempts with the same two objects
constexpr std::size_t kAttempts = 3;  // pairs whose times are tried for verification

bool trustworthy(const Landmark& landmark) {
  return landmark.existence >= kMinExistence && landmark.observations >= kMinObservations;
}

// Movement between the robot poses at the two times, if the constellation is right.
RelativePose proposal(double t_a, double t_b, const Pose2& map_from_query, const KeyPoses& poses) {
  RelativePose out;
  out.t_a = t_a;
  out.t_b = t_b;
  out.a_from_b = poses.at(t_a).inverse() * toPose3(map_from_query) * poses.at(t_b);
  out.planar = true;
  out.source = "objects";
  return out;
}

}  // namespace

std::vector<Visits> splitByTime(const std::vector<Landmark>& landmarks, const SeenSpans& spans, double now,
                               double recent_s, std::size_t min_each) {
  std::set<double> times;
  for (const auto& landmark : landmarks)
    if (const auto span = spans.find(landmark.id);
        span != spans.end() && span->second.first >= now - recent_s)
      times.insert(span->second.first);
  std::vector<Visits> out;
  for (const double split_t : times) {
    Visits visits;
    for (const auto& landmark : landmarks) {
      const auto span = spans.find(landmark.id);
      if (span == spans.end() || !trustworthy(landmark)) continue;
      if (span->second.first >= split_t) visits.recent.push_back(landmark);
      if (span->second.last < split_t) visits.old.push_back(landmark);
    }
    if (std::min(visits.recent.size(), visits.old.size()) >= min_each) out.push_back(std::move(visits));
  }
  return out;
}

std::optional<RelativePose> ObjectLoopCloser::search(const ObjectMapper& objects, const KeyPoses& poses,
                                                     const ClosureVerifier& verify) {
  if (!options_.enabled || ++nodes_since_search_ < options_.every_nodes) return std::nullopt;
  nodes_since_search_ = 0;
  const auto& rule = options_.constellation;
  for (const Visits& visits :
       splitByTime(objects.landmarks().landmarks(), objects.seenSpans(), poses.nodes().back().t,
                  options_.recent_s, static_cast<std::size_t>(rule.min_pairs))) {
    const auto match = matchConstellation(visits.recent, visits.old, rule);
    if (!match) continue;
    if (auto closure = confirm(*match, visits, objects.seenSpans(), poses, verify)) return closure;
  }
  return std::nullopt;
}

std::optional<RelativePose> ObjectLoopCloser::confirm(const ConstellationMatch& match, const Visits& visits,
                                                      const SeenSpans& spans, const KeyPoses& poses,
                                                      const ClosureVerifier& verify) {
  const Eigen::Vector2d place = visits.recent[match.pairs.front().first].position.head<2>();
  if ((match.map_from_query * place - place).norm() < options_.min_shift_m) return std::nullopt;
  for (std::size_t i = 0; i < std::min(kAttempts, match.pairs.size()); ++i) {
    const auto& [recent, old] = match.pairs[i];
    const std::pair ids{visits.recent[recent].id, visits.old[old].id};
    const double t_a = spans.at(ids.second).last, t_b = spans.at(ids.first).last;
    // Verification is expensive, and has the same result until the robot has moved on.
    const auto before = refused_.find(ids);
    if (before != refused_.end() && t_b - before->second < kPause_s) continue;
    refused_[ids] = t_b;
    auto closure = verify(proposal(t_a, t_b, match.map_from_query, poses));
    if (!closure) continue;
    closure->source = "objects";
    return closure;
  }
  return std::nullopt;
}

}  // namespace roomgraph
