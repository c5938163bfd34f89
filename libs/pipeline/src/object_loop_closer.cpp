// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/pipeline/object_loop_closer.h"

#include <algorithm>
#include <cmath>

namespace roomgraph {
namespace {

constexpr double kMinExistence = 0.5;  // what is rather not there must not close loops
constexpr int kMinObservations = 3;
constexpr std::size_t kAttempts = 3;  // pairs whose times are tried for verification

bool trustworthy(const Landmark& landmark) {
  return landmark.existence >= kMinExistence && landmark.observations >= kMinObservations;
}

// Robot poses at the two times, as they lie on each other when the constellation is right.
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

LandmarkAges splitByAge(const std::vector<Landmark>& landmarks, const std::map<LandmarkId, SeenSpan>& spans,
                        double now, double recent_s) {
  LandmarkAges out;
  double first_recent = now;
  for (const auto& landmark : landmarks) {
    const auto span = spans.find(landmark.id);
    if (span == spans.end() || !trustworthy(landmark) || span->second.first < now - recent_s) continue;
    out.recent.push_back(landmark);
    first_recent = std::min(first_recent, span->second.first);
  }
  for (const auto& landmark : landmarks) {
    const auto span = spans.find(landmark.id);
    if (span != spans.end() && trustworthy(landmark) && span->second.last < first_recent)
      out.old.push_back(landmark);
  }
  return out;
}

std::optional<RelativePose> ObjectLoopCloser::search(const ObjectMapper& objects, const KeyPoses& poses,
                                                     const ClosureVerifier& verify) {
  if (!options_.enabled || ++nodes_since_search_ < options_.every_nodes) return std::nullopt;
  nodes_since_search_ = 0;
  const auto spans = objects.seenSpans();
  const double now = poses.nodes().back().t;
  const LandmarkAges ages = splitByAge(objects.landmarks().landmarks(), spans, now, options_.recent_s);
  const auto match = matchConstellation(ages.recent, ages.old, options_.constellation);
  if (!match) return std::nullopt;
  const Landmark& some = ages.recent[match->pairs.front().first];
  const Eigen::Vector2d place = some.position.head<2>();
  if ((match->map_from_query * place - place).norm() < options_.min_shift_m) return std::nullopt;
  for (std::size_t i = 0; i < std::min(kAttempts, match->pairs.size()); ++i) {
    const auto& [recent, old] = match->pairs[i];
    const double t_a = spans.at(ages.old[old].id).last, t_b = spans.at(ages.recent[recent].id).last;
    auto closure = verify(proposal(t_a, t_b, match->map_from_query, poses));
    if (!closure) continue;
    closure->source = "objects";
    return closure;
  }
  return std::nullopt;
}

}  // namespace roomgraph
