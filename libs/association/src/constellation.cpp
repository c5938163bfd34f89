// SPDX-License-Identifier: BSD-3-Clause
// Pair-wise transform hypotheses, voting with one-to-one pairs, Umeyama refinement and ambiguity test.
#include "roomgraph/association/constellation.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace roomgraph {
namespace {

constexpr double kSameShift_m = 0.5, kSameTurn_rad = 0.2;  // nearer transforms count as equal

Eigen::Vector2d placeOf(const Landmark& landmark) {
  return landmark.position.head<2>();
}

// Whether two fronts agree under a rotation, up to half a turn: front and back are easily confused.
bool fitsYaw(const Landmark& q, const Landmark& m, double turn, double tolerance) {
  if (!q.has_yaw || !m.has_yaw) return true;
  const double difference = std::abs(wrapAngle(q.yaw + turn - m.yaw));
  return std::min(difference, std::numbers::pi - difference) <= tolerance;
}

// Least squares: map = R query + t (Umeyama 1991, without scale).
Pose2 align(const std::vector<Eigen::Vector2d>& from, const std::vector<Eigen::Vector2d>& to) {
  Eigen::Vector2d mean_from = Eigen::Vector2d::Zero(), mean_to = mean_from;
  for (std::size_t i = 0; i < from.size(); ++i) mean_from += from[i], mean_to += to[i];
  mean_from /= static_cast<double>(from.size());
  mean_to /= static_cast<double>(to.size());
  double sine = 0, cosine = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Eigen::Vector2d a = from[i] - mean_from, b = to[i] - mean_to;
    cosine += a.dot(b);
    sine += a.x() * b.y() - a.y() * b.x();
  }
  const double yaw = std::atan2(sine, cosine);
  const Eigen::Vector2d shift = mean_to - Eigen::Rotation2Dd(yaw) * mean_from;
  return {shift.x(), shift.y(), yaw};
}

// Inliers of a transform: pairs within tolerance, nearest first, each object once.
ConstellationMatch vote(const Pose2& map_from_query, const std::vector<Landmark>& query,
                        const std::vector<Landmark>& map, const ConstellationOptions& options) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> near;
  for (std::size_t i = 0; i < query.size(); ++i) {
    const Eigen::Vector2d place = map_from_query * placeOf(query[i]);
    for (std::size_t k = 0; k < map.size(); ++k) {
      const double distance = (place - placeOf(map[k])).norm();
      if (distance > options.tolerance_m || query[i].class_name != map[k].class_name) continue;
      if (fitsYaw(query[i], map[k], map_from_query.yaw, options.yaw_tolerance))
        near.emplace_back(distance, i, k);
    }
  }
  std::sort(near.begin(), near.end());
  ConstellationMatch match{map_from_query, {}, 0};
  std::vector<char> used_query(query.size(), 0), used_map(map.size(), 0);
  for (const auto& [distance, i, k] : near) {
    if (used_query[i] || used_map[k]) continue;
    used_query[i] = used_map[k] = 1;
    match.pairs.emplace_back(i, k);
    match.rms_m += distance * distance;
  }
  std::sort(match.pairs.begin(), match.pairs.end());
  if (!match.pairs.empty()) match.rms_m = std::sqrt(match.rms_m / static_cast<double>(match.pairs.size()));
  return match;
}

ConstellationMatch refined(const ConstellationMatch& match, const std::vector<Landmark>& query,
                           const std::vector<Landmark>& map, const ConstellationOptions& options) {
  std::vector<Eigen::Vector2d> from, to;
  for (const auto& [i, k] : match.pairs) {
    from.push_back(placeOf(query[i]));
    to.push_back(placeOf(map[k]));
  }
  return vote(align(from, to), query, map, options);
}

bool better(const ConstellationMatch& a, const ConstellationMatch& b) {
  return a.pairs.size() != b.pairs.size() ? a.pairs.size() > b.pairs.size() : a.rms_m < b.rms_m;
}

// One transform per two pairs of objects that are equally far apart.
std::vector<ConstellationMatch> candidates(const std::vector<Landmark>& query,
                                           const std::vector<Landmark>& map,
                                           const ConstellationOptions& options) {
  std::vector<ConstellationMatch> out;
  for (std::size_t i = 0; i < query.size(); ++i) {
    for (std::size_t j = i + 1; j < query.size(); ++j) {
      const double apart = (placeOf(query[i]) - placeOf(query[j])).norm();
      if (apart < options.min_separation_m) continue;
      for (std::size_t k = 0; k < map.size(); ++k) {
        for (std::size_t l = 0; l < map.size(); ++l) {
          if (k == l || query[i].class_name != map[k].class_name || query[j].class_name != map[l].class_name)
            continue;
          if (std::abs((placeOf(map[k]) - placeOf(map[l])).norm() - apart) > options.tolerance_m) continue;
          const Pose2 guess =
              align({placeOf(query[i]), placeOf(query[j])}, {placeOf(map[k]), placeOf(map[l])});
          const ConstellationMatch match = vote(guess, query, map, options);
          if (static_cast<int>(match.pairs.size()) >= options.min_pairs) out.push_back(match);
        }
      }
    }
  }
  return out;
}

bool sameTransform(const Pose2& a, const Pose2& b, const Eigen::Vector2d& at) {
  return (a * at - b * at).norm() < kSameShift_m && std::abs(wrapAngle(a.yaw - b.yaw)) < kSameTurn_rad;
}

}  // namespace

std::optional<ConstellationMatch> matchConstellation(const std::vector<Landmark>& query,
                                                     const std::vector<Landmark>& map,
                                                     const ConstellationOptions& options) {
  auto found = candidates(query, map, options);
  for (auto& match : found)
    if (const auto next = refined(match, query, map, options); better(next, match)) match = next;
  if (found.empty()) return std::nullopt;
  const auto best = *std::min_element(found.begin(), found.end(), better);
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const auto& landmark : query) middle += placeOf(landmark) / static_cast<double>(query.size());
  for (const auto& other : found) {
    if (sameTransform(other.map_from_query, best.map_from_query, middle)) continue;
    if (other.pairs.size() + static_cast<std::size_t>(options.min_lead) > best.pairs.size())
      return std::nullopt;
  }
  return best;
}

}  // namespace roomgraph
