// SPDX-License-Identifier: BSD-3-Clause
// Matching of landmarks of two sessions, evidence of a look at a place, and fusion.
#include "roomgraph/estimation/landmark_continuation.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <tuple>

#include "roomgraph/association/landmark_union.h"
#include "roomgraph/association/world_measurement.h"

namespace roomgraph {
namespace {

constexpr double kOneThing = 0.5;  // overlap in space from which two classes are two labels of one thing
// Of a place that was seen: log ratio when nothing fills it, and when enough does. Of true landmarks about a
// third is filled, as shapes are boxes around things (existence.h: filled).
constexpr double kEmpty = -3, kFull = 2;
constexpr double kFilledEnough = 0.15;
constexpr double kMissed =
    -0.75;  // log((1 - 0.6) / (1 - 0.15)): [landmarks] detection_probability, false_alarm_...
constexpr int kMostMissed = 5;    // a detector that overlooks a thing once does so again
constexpr double kSurest = 0.99;  // things are moved between two sessions

double ofRays(double known, double filled) {
  const double share = std::min(1.0, filled / kFilledEnough);
  return known * (kEmpty + share * (kFull - kEmpty));
}

double probabilityOf(double log_odds) {
  return 1 / (1 + std::exp(-log_odds));
}

const WeighedLandmark* findIn(const std::vector<WeighedLandmark>& all, LandmarkId id) {
  const auto found = std::find_if(all.begin(), all.end(),
                                  [id](const WeighedLandmark& one) { return one.landmark.id == id; });
  return found == all.end() ? nullptr : &*found;
}

bool overlap(const Landmark& a, const Landmark& b, double most) {
  return footprintOverlap(a.shape, a.worldFromObject(), b.shape, b.worldFromObject()) > most;
}

std::string likeliestClass(const Landmark& landmark) {
  const auto& classes = landmark.class_posterior;
  const auto most = std::max_element(classes.begin(), classes.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == classes.end() ? landmark.class_name : most->first;
}

constexpr double kSessions_m = 0.1, kSessions_rad = 0.2;  // by which things are nudged between two sessions
constexpr double kElsewhere2 = 9;                        // squared, in standard deviations

// Whether both cannot be estimates of one place: it was moved, and stands where it was seen last.
bool standsElsewhere(const Landmark& then, const Landmark& now) {
  const Eigen::Vector2d gap = (now.position - then.position).head<2>();
  Eigen::Matrix2d both = (then.covariance + now.covariance).topLeftCorner<2, 2>();
  both.diagonal().array() += kSessions_m * kSessions_m;
  if (gap.dot(both.inverse() * gap) > kElsewhere2) return true;
  if (!then.has_yaw || !now.has_yaw) return false;
  const double turn = std::abs(wrapAngle(now.yaw - then.yaw)), alike = std::min(turn, std::numbers::pi - turn);
  return alike * alike > kElsewhere2 * (then.covariance(3, 3) + now.covariance(3, 3) + kSessions_rad * kSessions_rad);
}

// What another session says of a place now.
Landmark nudged(Landmark landmark) {
  landmark.covariance(0, 0) += kSessions_m * kSessions_m;
  landmark.covariance(1, 1) += kSessions_m * kSessions_m;
  return landmark;
}

// Of one object; when the classes differ the likelier one has shape and place.
WeighedLandmark fusedOf(const WeighedLandmark& earlier, const WeighedLandmark& now) {
  WeighedLandmark out = earlier;
  const auto classes = combinedClasses(earlier.landmark.class_posterior, earlier.weight,
                                       now.landmark.class_posterior, now.weight);
  out.weight = earlier.weight + now.weight;
  if (earlier.landmark.class_name == now.landmark.class_name) {
    const bool moved = now.landmark.stands_since || standsElsewhere(earlier.landmark, now.landmark);
    out.landmark = moved ? now.landmark : fusedEstimates(nudged(earlier.landmark), now.landmark);
  } else {
    Landmark either = earlier.landmark;
    either.class_posterior = classes;
    if (likeliestClass(either) == now.landmark.class_name) out.landmark = now.landmark;
  }
  out.landmark.observations = earlier.landmark.observations + now.landmark.observations;
  out.landmark.id = earlier.landmark.id;
  out.landmark.class_posterior = classes;
  return out;
}

}  // namespace

double logRatioOf(const PlaceLook& look) {
  return kMissed * std::min(look.missed, kMostMissed) + ofRays(look.known, look.filled) +
         ofRays(look.beams_known, look.beams_filled);
}

std::map<LandmarkId, LandmarkId> sameLandmarks(const std::vector<Landmark>& own,
                                               const std::vector<Landmark>& earlier,
                                               const DuplicateRule& rule) {
  std::set<LandmarkId> taken, known;
  for (const Landmark& old : earlier) known.insert(old.id);
  for (const Landmark& landmark : own)
    if (known.contains(landmark.id)) taken.insert(landmark.id);
  std::vector<std::tuple<double, LandmarkId, LandmarkId>> pairs;
  for (const Landmark& landmark : own)
    for (const Landmark& old : earlier) {
      if (known.contains(landmark.id) || taken.contains(old.id)) continue;
      const bool same = landmark.class_name == old.class_name
                            ? rule.same(landmark, old, 0)
                            : iou3d(landmark.shape, landmark.worldFromObject(), old.shape,
                                    old.worldFromObject()) > kOneThing;
      if (same) pairs.emplace_back((landmark.position - old.position).head<2>().norm(), landmark.id, old.id);
    }
  std::sort(pairs.begin(), pairs.end());
  std::map<LandmarkId, LandmarkId> out;
  for (const auto& [distance, id, old] : pairs)
    if (!out.contains(id) && taken.insert(old).second) out[id] = old;
  return out;
}

ContinuedLandmarks continuedLandmarks(const std::vector<WeighedLandmark>& earlier,
                                      const std::vector<PlaceLook>& looks,
                                      const std::vector<WeighedLandmark>& candidates,
                                      const std::vector<LandmarkId>& own, const ContinuationRule& rule) {
  ContinuedLandmarks out;
  std::vector<WeighedLandmark> fresh;
  for (const LandmarkId id : own)
    if (!findIn(earlier, id))
      if (const auto* now = findIn(candidates, id)) fresh.push_back(*now);
  for (std::size_t i = 0; i < earlier.size(); ++i) {
    WeighedLandmark kept = earlier[i];
    const double before = std::min(kept.landmark.existence, kSurest);
    const double look = probabilityOf(logRatioOf(looks.at(i)));
    const WeighedLandmark* now = findIn(candidates, kept.landmark.id);
    // A candidate that is no object is no sighting of this one either.
    if (now && now->landmark.existence < rule.least_existence) now = nullptr;
    if (now) kept = fusedOf(earlier[i], *now);
    // Few sightings of what is known to be there do not speak against it.
    const double said = now ? std::max(look, now->landmark.existence) : look;
    const bool untouched = !now && logRatioOf(looks[i]) == 0;
    kept.landmark.existence = untouched ? earlier[i].landmark.existence : combinedExistence(before, said);
    // What stands there now was seen no worse, or this one was looked for in vain.
    const bool replaced = !now && std::any_of(fresh.begin(), fresh.end(), [&](const WeighedLandmark& other) {
      return overlap(kept.landmark, other.landmark, rule.exclusive_overlap) && (logRatioOf(looks[i]) < 0 || other.weight >= kept.weight);
    });
    if (replaced || kept.landmark.existence < rule.least_existence) {
      ++out.vanished;
      continue;
    }
    ++(now ? out.seen_again : out.unseen);
    out.landmarks.push_back(std::move(kept));
  }
  for (const WeighedLandmark& one : fresh) {
    const bool free =
        std::none_of(out.landmarks.begin(), out.landmarks.end(), [&](const WeighedLandmark& kept) {
          return overlap(kept.landmark, one.landmark, rule.exclusive_overlap);
        });
    if (!free) continue;
    ++out.appeared;
    out.landmarks.push_back(one);
  }
  std::sort(out.landmarks.begin(), out.landmarks.end(),
            [](const WeighedLandmark& a, const WeighedLandmark& b) { return a.landmark.id < b.landmark.id; });
  return out;
}

}  // namespace roomgraph
