// SPDX-License-Identifier: BSD-3-Clause
// Pairing of objects, and Bayes' rule for those without a partner.
#include "roomgraph/maptools/map_difference.h"

#include <numbers>

#include "change_evidence.h"

namespace roomgraph {
namespace {

constexpr double kNewPerM2 = 0.002;    // density of objects that appear, of one class
constexpr double kSizeSigma = 0.25;    // of the logarithm of a length, between two sessions
constexpr double kYawSigma_rad = 0.2;  // of a yaw, besides its covariance
constexpr double kLikely = 0.5;

double normal2(const Eigen::Vector2d& offset, const Eigen::Matrix2d& covariance) {
  return std::exp(-0.5 * offset.dot(covariance.inverse() * offset)) /
         (2 * std::numbers::pi * std::sqrt(covariance.determinant()));
}

// Density of the difference of two yaws, rad^-1, front and back being confused easily; uniform where one is
// unknown.
double yawDensity(const Landmark& a, const Landmark& b) {
  if (!a.has_yaw || !b.has_yaw) return 1 / std::numbers::pi;
  double difference = std::abs(wrapAngle(a.yaw - b.yaw));
  difference = std::min(difference, std::numbers::pi - difference);
  const double variance = a.covariance(3, 3) + b.covariance(3, 3) + kYawSigma_rad * kYawSigma_rad;
  return std::exp(-difference * difference / (2 * variance)) / std::sqrt(2 * std::numbers::pi * variance);
}

double sizeLikeness(const ObjectShape& a, const ObjectShape& b) {
  double exponent = 0;
  for (const auto& [x, y] : {std::pair{a.width, b.width}, {a.depth, b.depth}, {a.height, b.height}}) {
    const double ratio = std::log(std::max(x, 0.05) / std::max(y, 0.05)) / kSizeSigma;
    exponent += ratio * ratio / 2;
  }
  return std::exp(-exponent);
}

/// Two objects as one: how likely, against one that vanished and another that appeared.
struct ObjectPair {
  std::size_t before = 0, after = 0;
  double odds = 0, moved = 0;  ///< of being one; probability that it was moved if so
};

ObjectPair pairOf(const Landmark& a, const Landmark& b, const MapDifferenceOptions& options) {
  const Eigen::Vector2d offset = (b.position - a.position).head<2>();
  const Eigen::Matrix2d here = a.covariance.topLeftCorner<2, 2>() + b.covariance.topLeftCorner<2, 2>() +
                               options.place_sigma_m * options.place_sigma_m * Eigen::Matrix2d::Identity();
  const Eigen::Matrix2d around =
      here + options.move_sigma_m * options.move_sigma_m * Eigen::Matrix2d::Identity();
  const double stayed = (1 - options.moves - options.vanishes) * normal2(offset, here) * yawDensity(a, b);
  const double moved = options.moves * normal2(offset, around) / std::numbers::pi;
  const double apart = options.vanishes * kNewPerM2 / std::numbers::pi;
  return {0, 0, (stayed + moved) * sizeLikeness(a.shape, b.shape) / apart, moved / (stayed + moved)};
}

std::vector<ObjectPair> pairsOf(const CSemanticMap& before, const CSemanticMap& after,
                                const MapDifferenceOptions& options) {
  std::vector<ObjectPair> all, chosen;
  for (std::size_t i = 0; i < before.landmarks.size(); ++i)
    for (std::size_t k = 0; k < after.landmarks.size(); ++k) {
      if (before.landmarks[i].class_name != after.landmarks[k].class_name) continue;
      ObjectPair pair = pairOf(before.landmarks[i], after.landmarks[k], options);
      pair.before = i;
      pair.after = k;
      if (pair.odds > 1) all.push_back(pair);
    }
  std::stable_sort(all.begin(), all.end(),
                   [](const ObjectPair& x, const ObjectPair& y) { return x.odds > y.odds; });
  std::vector<char> used_before(before.landmarks.size(), 0), used_after(after.landmarks.size(), 0);
  for (const auto& pair : all) {
    if (used_before[pair.before] || used_after[pair.after]) continue;
    used_before[pair.before] = used_after[pair.after] = 1;
    // Other partners that it could have had, among those that are still free.
    double others = 0;
    for (const auto& other : all)
      if ((other.before == pair.before && !used_after[other.after]) ||
          (other.after == pair.after && !used_before[other.before]))
        others += other.odds;
    chosen.push_back(pair);
    chosen.back().odds = pair.odds / (1 + others);
  }
  return chosen;
}

// Both exist, are one, and the object is gone from where it was and was not where it is now.
double movedProbability(const ObjectPair& pair, const CSemanticMap& before, const CSemanticMap& after,
                        const MapDifferenceOptions& options) {
  const Landmark &a = before.landmarks[pair.before], &b = after.landmarks[pair.after];
  const double both = a.existence * b.existence * pair.odds / (1 + pair.odds) * pair.moved;
  // Cells tell nothing where the old and the new place overlap.
  if ((a.position - b.position).head<2>().norm() < a.shape.horizontalExtent()) return both;
  const auto changed = [&](const PlaceEvidence& place) {
    return place.probabilityOfChange(0.5, options.found);
  };
  return both * changed(placeEvidence(a, before, after)) * changed(placeEvidence(b, after, before));
}

ObjectDifference alone(const CSemanticMap& own, const Landmark& landmark, const CSemanticMap& other,
                       bool vanished, const MapDifferenceOptions& options) {
  ObjectDifference out;
  (vanished ? out.before : out.after) = landmark;
  const PlaceEvidence place = placeEvidence(landmark, own, other);
  out.seen = place.seen;
  out.probability = landmark.existence *
                    place.probabilityOfChange(vanished ? options.vanishes : options.appears, options.found);
  if (out.probability >= kLikely) out.change = vanished ? ObjectChange::kVanished : ObjectChange::kAppeared;
  return out;
}

}  // namespace

std::string toString(ObjectChange change) {
  switch (change) {
    case ObjectChange::kStayed:
      return "stayed";
    case ObjectChange::kMoved:
      return "moved";
    case ObjectChange::kVanished:
      return "vanished";
    case ObjectChange::kAppeared:
      return "appeared";
    case ObjectChange::kUnsure:
      break;
  }
  return "unsure";
}

std::vector<ObjectDifference> differenceOf(const CSemanticMap& before, const CSemanticMap& after,
                                           const MapDifferenceOptions& options) {
  std::vector<std::optional<ObjectPair>> partner_of(before.landmarks.size());
  std::vector<char> explained(after.landmarks.size(), 0);
  std::vector<ObjectDifference> out;
  for (const auto& pair : pairsOf(before, after, options)) {
    if (pair.moved > kLikely && movedProbability(pair, before, after, options) < kLikely) continue;
    partner_of[pair.before] = pair;
    explained[pair.after] = 1;
  }
  for (std::size_t i = 0; i < before.landmarks.size(); ++i) {
    const Landmark& a = before.landmarks[i];
    if (!partner_of[i]) {
      out.push_back(alone(before, a, after, true, options));
      continue;
    }
    const ObjectPair& pair = *partner_of[i];
    const Landmark& b = after.landmarks[pair.after];
    const double one = pair.odds / (1 + pair.odds);
    if (pair.moved > kLikely)
      out.push_back({ObjectChange::kMoved, a, b, movedProbability(pair, before, after, options), 1});
    else
      out.push_back({ObjectChange::kStayed, a, b, one * (1 - pair.moved), 1});
  }
  for (std::size_t k = 0; k < after.landmarks.size(); ++k)
    if (!explained[k]) out.push_back(alone(after, after.landmarks[k], before, false, options));
  return out;
}

}  // namespace roomgraph
