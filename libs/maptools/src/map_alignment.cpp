// SPDX-License-Identifier: BSD-3-Clause
// Proposals by objects and walls, their evidence, and the choice among them.
#include "roomgraph/maptools/map_alignment.h"

#include <numbers>
#include <optional>

#include "roomgraph/association/constellation.h"
#include "roomgraph/geometry/covariance.h"
#include "roomgraph/lidar/grid_locator.h"
#include "text_numbers.h"
#include "wall_evidence.h"

namespace roomgraph {
namespace {

constexpr double kPlaceSigma_m = 0.1;        // of an object between two sessions, besides its covariance
constexpr double kStays = 0.8, kGone = 0.3;  // chance that an object is where it was; that one is not found
constexpr double kPairReach_m = 0.5, kMostPairEvidence = 4;
constexpr double kSamePlace_m = 0.5, kSameTurn_rad = 0.2;
constexpr int kPairsWithoutWalls = 4;
constexpr std::size_t kMostObjects = 60;  // in each map; the search grows with the fourth power

struct Weighed {
  MapAlignment alignment;
  double evidence = 0;  // log likelihood ratio against maps that have nothing in common
};

/// Both maps as they are compared.
struct MapPair {
  const CSemanticMap &a, &b;
  std::optional<WallGrid> walls_a, walls_b;

  MapPair(const CSemanticMap& first, const CSemanticMap& second) : a(first), b(second) {
    if (!a.occupancy || !b.occupancy) return;
    walls_a.emplace(*a.occupancy);
    walls_b.emplace(*b.occupancy);
  }
  bool haveWalls() const { return walls_a && !walls_a->points().empty() && !walls_b->points().empty(); }
  // Transforms that differ, over the area of the larger map.
  double distinguishable() const {
    const double area = walls_a ? std::max(walls_a->knownArea(), walls_b->knownArea()) : 100;
    return std::max(1.0, area / (kSamePlace_m * kSamePlace_m)) * 2 * std::numbers::pi / kSameTurn_rad;
  }
};

// Objects of b that lie on one of a, against as many at random; those that should be there and are not.
void addObjects(const MapPair& maps, Weighed& weighed) {
  const double area = std::max(10.0, maps.walls_a ? maps.walls_a->knownArea() : 100.0);
  std::vector<char> used(maps.a.landmarks.size(), 0);
  for (const auto& object : maps.b.landmarks) {
    const Eigen::Vector2d at = weighed.alignment.a_from_b * Eigen::Vector2d(object.position.head<2>());
    double nearest = kPairReach_m;
    std::size_t partner = used.size(), of_class = 0;
    for (std::size_t i = 0; i < used.size(); ++i) {
      if (maps.a.landmarks[i].class_name != object.class_name) continue;
      ++of_class;
      const double distance = (maps.a.landmarks[i].position.head<2>() - at).norm();
      if (!used[i] && distance < nearest) nearest = distance, partner = i;
    }
    if (partner == used.size()) {
      if (of_class > 0) weighed.evidence += std::log(kGone) / 2;
      continue;
    }
    used[partner] = 1;
    ++weighed.alignment.pairs;
    const double variance =
        kPlaceSigma_m * kPlaceSigma_m + (maps.a.landmarks[partner].covariance.topLeftCorner<2, 2>().trace() +
                                         object.covariance.topLeftCorner<2, 2>().trace()) /
                                            2;
    const double density = std::exp(-nearest * nearest / (2 * variance)) / (2 * std::numbers::pi * variance);
    const double ratio = kStays * density * area / static_cast<double>(of_class) + kGone;
    weighed.evidence += std::clamp(std::log(ratio), std::log(kGone), kMostPairEvidence);
  }
}

Weighed weigh(const MapPair& maps, const Pose2& a_from_b, const Eigen::Matrix3d& covariance) {
  Weighed out;
  out.alignment.a_from_b = a_from_b;
  out.alignment.covariance = covariance;
  addObjects(maps, out);
  if (!maps.haveWalls()) return out;
  const auto there = maps.walls_a->agreement(maps.walls_b->points(), a_from_b);
  const auto back = maps.walls_b->agreement(maps.walls_a->points(), a_from_b.inverse());
  out.evidence += (there.evidence + back.evidence) / 2;
  out.alignment.walls_m =
      (there.explained_m + there.contradicted_m + back.explained_m + back.contradicted_m) / 2;
  out.alignment.explained = std::min(there.share(), back.share());
  out.alignment.overlap = std::max(maps.walls_a->sharedWith(*maps.walls_b, a_from_b.inverse()),
                                   maps.walls_b->sharedWith(*maps.walls_a, a_from_b));
  return out;
}

bool alike(const Pose2& first, const Pose2& second, const Eigen::Vector2d& at) {
  return (first * at - second * at).norm() < kSamePlace_m &&
         std::abs(wrapAngle(first.yaw - second.yaw)) < kSameTurn_rad;
}

std::optional<Pose2> proposedByObjects(const MapPair& maps) {
  const auto &query = maps.b.landmarks, &map = maps.a.landmarks;
  if (maps.haveWalls() && query.size() * map.size() > kMostObjects * kMostObjects) return std::nullopt;
  ConstellationOptions rule;
  rule.min_pairs = maps.haveWalls() ? 2 : kPairsWithoutWalls;
  if (maps.haveWalls()) rule.min_lead = 0;  // the walls tell which of several is right
  const auto match = matchConstellation(query, map, rule);
  return match ? std::optional(match->map_from_query) : std::nullopt;
}

// Different transforms, the best one first. Maps that hardly overlap agree easily, wall against wall: such
// transforms are none.
std::vector<Weighed> candidatesFor(const MapPair& maps, double least_overlap) {
  std::vector<Pose2> proposed;
  if (const auto pose = proposedByObjects(maps)) proposed.push_back(*pose);
  std::vector<Weighed> out;
  const Eigen::Matrix3d by_objects = Eigen::Vector3d(0.05 * 0.05, 0.05 * 0.05, 0.02 * 0.02).asDiagonal();
  if (!maps.haveWalls()) {
    for (const auto& pose : proposed) out.push_back(weigh(maps, pose, by_objects));
    return out;
  }
  const GridLocator locator(*maps.a.occupancy);
  for (const auto& pose : locator.search(maps.walls_b->points())) proposed.push_back(pose);
  const GridLocator backwards(
      *maps.b.occupancy);  // a part is found in the whole more easily than the whole in a part
  for (const auto& pose : backwards.search(maps.walls_a->points())) proposed.push_back(pose.inverse());
  for (const auto& pose : proposed) {
    const GridFit fit = locator.refine(maps.walls_b->points(), pose);
    const Weighed weighed = weigh(maps, fit.grid_from_points, fit.covariance);
    if (weighed.alignment.overlap >= least_overlap) out.push_back(weighed);
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const Weighed& x, const Weighed& y) { return x.evidence > y.evidence; });
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const auto& p : maps.walls_b->points())
    middle += p / static_cast<double>(maps.walls_b->points().size());
  std::vector<Weighed> different;
  for (const auto& one : out)
    if (std::none_of(different.begin(), different.end(), [&](const Weighed& better) {
          return alike(one.alignment.a_from_b, better.alignment.a_from_b, middle);
        }))
      different.push_back(one);
  return different;
}

// Posterior of the best: all distinguishable transforms together are as likely beforehand as none.
double posteriorOfBest(const std::vector<Weighed>& candidates, double distinguishable) {
  const double best = candidates.front().evidence;
  double sum = distinguishable * std::exp(-best);
  for (const auto& one : candidates) sum += std::exp(one.evidence - best);
  return 1 / sum;
}

std::string whyNot(const std::vector<Weighed>& candidates, const MapPair& maps,
                   const MapAlignmentOptions& options) {
  const MapAlignment& best = candidates.front().alignment;
  if (maps.haveWalls() && best.walls_m < options.least_walls_m)
    return "only " + decimals(best.walls_m, 1) + " m of walls are seen in both";
  if (maps.haveWalls() && best.explained < options.least_explained)
    return "under the best transform only " + decimals(100 * best.explained, 0) + " % of the walls agree";
  if (!(best.probability < options.least_probability)) return "";
  if (candidates.size() > 1 && candidates[1].evidence > candidates[0].evidence - 3)
    return "ambiguous: another transform, " +
           decimals(
               (best.a_from_b.inverse() * candidates[1].alignment.a_from_b * Eigen::Vector2d(0, 0)).norm(),
               1) +
           " m away, explains the maps nearly as well";
  return "the best transform is right with a probability of " + decimals(best.probability, 2) + " only";
}

}  // namespace

Outcome<MapAlignment> alignMaps(const CSemanticMap& a, const CSemanticMap& b,
                                const MapAlignmentOptions& options) {
  const MapPair maps(a, b);
  if (options.same_frame) return weigh(maps, {}, Eigen::Matrix3d::Zero()).alignment;
  auto candidates = candidatesFor(maps, options.least_overlap);
  if (candidates.empty())
    return Outcome<MapAlignment>::failure(
        "no transform puts objects on objects of their class or walls on walls");
  candidates.front().alignment.probability = posteriorOfBest(candidates, maps.distinguishable());
  if (auto reason = whyNot(candidates, maps, options); !reason.empty())
    return Outcome<MapAlignment>::failure(std::move(reason));
  return candidates.front().alignment;
}

}  // namespace roomgraph
