// SPDX-License-Identifier: BSD-3-Clause
// Pair-wise transform hypotheses, voting with one-to-one pairs, Umeyama refinement and ambiguity test.
#include "roomgraph/association/constellation.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>
#include <unordered_map>

namespace roomgraph {
namespace {

constexpr double kSameShift_m = 0.5, kSameTurn_rad = 0.2;  // nearer transforms count as equal
constexpr std::size_t kMostAnchors = 15;  // objects whose pairs propose transforms: the search grows with their square

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

// Landmarks of a map by where they stand, in squares of one side.
class PlacesOfMap {
 public:
  PlacesOfMap(const std::vector<Landmark>& map, double side_m) : side_m_(side_m) {
    for (std::size_t k = 0; k < map.size(); ++k) squares_[squareOf(placeOf(map[k]), 0, 0)].push_back(k);
  }

  /// Calls `f` with each one less than the side away, and with others.
  template <class F>
  void forNear(const Eigen::Vector2d& place, const F& f) const {
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        if (const auto found = squares_.find(squareOf(place, dx, dy)); found != squares_.end())
          for (const std::size_t k : found->second) f(k);
  }

 private:
  std::uint64_t squareOf(const Eigen::Vector2d& place, int dx, int dy) const {
    const auto index = [this](double value) { return static_cast<std::int64_t>(std::floor(value / side_m_)); };
    return static_cast<std::uint64_t>(index(place.x()) + dx) * 0x100000001ull + static_cast<std::uint64_t>(index(place.y()) + dy);
  }

  double side_m_;
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> squares_;
};

// Inliers of a transform: pairs within tolerance, nearest first, each object once.
ConstellationMatch vote(const Pose2& map_from_query, const std::vector<Landmark>& query,
                        const std::vector<Landmark>& map, const PlacesOfMap& places, const ConstellationOptions& options) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> near;
  for (std::size_t i = 0; i < query.size(); ++i) {
    const Eigen::Vector2d place = map_from_query * placeOf(query[i]);
    places.forNear(place, [&](std::size_t k) {
      const double distance = (place - placeOf(map[k])).norm();
      if (distance > options.tolerance_m || query[i].class_name != map[k].class_name) return;
      if (fitsYaw(query[i], map[k], map_from_query.yaw, options.yaw_tolerance))
        near.emplace_back(distance, i, k);
    });
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
                           const std::vector<Landmark>& map, const PlacesOfMap& places, const ConstellationOptions& options) {
  std::vector<Eigen::Vector2d> from, to;
  for (const auto& [i, k] : match.pairs) {
    from.push_back(placeOf(query[i]));
    to.push_back(placeOf(map[k]));
  }
  return vote(align(from, to), query, map, places, options);
}

bool better(const ConstellationMatch& a, const ConstellationMatch& b) {
  return a.pairs.size() != b.pairs.size() ? a.pairs.size() > b.pairs.size() : a.rms_m < b.rms_m;
}

// Those of the query that have the fewest objects of their class in the map, in their order.
std::vector<std::size_t> anchorsOf(const std::vector<Landmark>& query, const std::vector<Landmark>& map) {
  std::vector<std::size_t> out(query.size());
  std::iota(out.begin(), out.end(), 0);
  if (out.size() <= kMostAnchors) return out;
  const auto alike = [&](std::size_t i) {
    return std::count_if(map.begin(), map.end(), [&](const Landmark& m) { return m.class_name == query[i].class_name; });
  };
  std::erase_if(out, [&](std::size_t i) { return alike(i) == 0; });
  if (out.size() <= kMostAnchors) return out;
  std::stable_sort(out.begin(), out.end(), [&](std::size_t a, std::size_t b) { return alike(a) < alike(b); });
  out.resize(kMostAnchors);
  std::sort(out.begin(), out.end());
  return out;
}

// One transform per two pairs of objects that are equally far apart.
std::vector<ConstellationMatch> candidates(const std::vector<Landmark>& query, const std::vector<Landmark>& map,
                                           const PlacesOfMap& places, const ConstellationOptions& options) {
  std::vector<ConstellationMatch> out;
  const std::vector<std::size_t> anchors = anchorsOf(query, map);
  for (auto a = anchors.begin(); a != anchors.end(); ++a) {
    for (auto b = std::next(a); b != anchors.end(); ++b) {
      const std::size_t i = *a, j = *b;
      const double apart = (placeOf(query[i]) - placeOf(query[j])).norm();
      if (apart < options.min_separation_m) continue;
      for (std::size_t k = 0; k < map.size(); ++k) {
        for (std::size_t l = 0; l < map.size(); ++l) {
          if (k == l || query[i].class_name != map[k].class_name || query[j].class_name != map[l].class_name)
            continue;
          if (std::abs((placeOf(map[k]) - placeOf(map[l])).norm() - apart) > options.tolerance_m) continue;
          const Pose2 guess =
              align({placeOf(query[i]), placeOf(query[j])}, {placeOf(map[k]), placeOf(map[l])});
          const ConstellationMatch match = vote(guess, query, map, places, options);
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
  const PlacesOfMap places(map, options.tolerance_m);
  auto found = candidates(query, map, places, options);
  for (auto& match : found)
    if (const auto next = refined(match, query, map, places, options); better(next, match)) match = next;
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
