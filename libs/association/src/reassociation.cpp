// SPDX-License-Identifier: BSD-3-Clause
// Rounds of smoothing, exclusive decisions, re-estimation, merging and splitting until no decision changes.
#include "roomgraph/association/reassociation.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <opencv2/core/utility.hpp>
#include <set>

#include "alternative_weights.h"
#include "feature_votes.h"
#include "roomgraph/association/landmark_fusion.h"
#include "track_memory.h"

namespace roomgraph {
namespace {

using Frames = std::vector<std::vector<WorldMeasurement>>;
using Decisions = std::vector<std::vector<BatchDecision>>;
constexpr double kNewObjectPriorInBatch = 0.01;  // prior of a new object once the whole run is known
constexpr int kLeastSightings = 3;               // that a landmark needs to compete for sightings of others

using Priors = std::vector<std::vector<std::vector<double>>>;  // by frame, measurement, alternative

// Parts of the E-step that are the same forwards and backwards in time.
struct Evidence {
  std::vector<std::vector<Alternatives>> alternatives;
  Priors shares;  // p0
};

using OwnBoxes = std::vector<std::vector<OwnBox>>;  // by frame, measurement

void inParallel(std::size_t count, const std::function<void(std::size_t)>& work) {
  cv::parallel_for_(cv::Range(0, static_cast<int>(count)), [&](const cv::Range& range) {
    for (int i = range.start; i < range.end; ++i) work(static_cast<std::size_t>(i));
  });
}

OwnBoxes ownBoxes(const Frames& frames, const MeasurementModel& model) {
  OwnBoxes out(frames.size());
  inParallel(frames.size(), [&](std::size_t f) {
    for (const auto& seen : frames[f]) out[f].push_back(model.ownBox(seen));
  });
  return out;
}

// `votes`: those of the decisions in `last`.
Evidence gather(const Frames& frames, const OwnBoxes& boxes, const FeatureVotes& votes, const Decisions& last,
                const std::vector<Landmark>& landmarks, const AssociationModel& model) {
  Evidence out{std::vector<std::vector<Alternatives>>(frames.size()), Priors(frames.size())};
  inParallel(frames.size(), [&](std::size_t f) {
    for (std::size_t k = 0; k < frames[f].size(); ++k) {
      out.alternatives[f].push_back(model.measurement.alternatives(frames[f][k], landmarks, boxes[f][k]));
      out.alternatives[f].back().fresh *= kNewObjectPriorInBatch;
      const LandmarkId own = last.empty() ? LandmarkId{} : last[f][k].landmark;
      out.shares[f].push_back(votes.shares(f, k, own, idsOf(out.alternatives[f][k]), model.neutral_features));
    }
  });
  return out;
}

std::vector<Association> decide(const Evidence& evidence, std::size_t f, const AssociationModel& model,
                                const std::vector<std::vector<double>>& priors) {
  std::vector<WeightedAlternatives> frame;
  for (std::size_t k = 0; k < priors.size(); ++k)
    frame.push_back(weigh(evidence.alternatives[f][k], model, priors[k], evidence.shares[f][k]));
  return decideFrame(frame);
}

// Priors from the tracks before each frame; backwards: after it.
Priors filter(const Frames& frames, const Evidence& evidence, const AssociationModel& model, bool backwards) {
  TrackMemory tracks(backwards);
  Priors out(frames.size());
  for (std::size_t step = 0; step < frames.size(); ++step) {
    const std::size_t f = backwards ? frames.size() - 1 - step : step;
    for (std::size_t k = 0; k < frames[f].size(); ++k)
      out[f].push_back(
          tracks.prior(frames[f][k].measurement, idsOf(evidence.alternatives[f][k]), model.forgetting));
    for (const auto& association : decide(evidence, f, model, out[f]))
      tracks.remember(frames[f][association.measurement].measurement, association.posterior);
  }
  return out;
}

std::vector<std::vector<Association>> smooth(const Frames& frames, const Evidence& evidence,
                                             const AssociationModel& model) {
  Priors both, later;
  inParallel(2, [&](std::size_t way) { (way == 0 ? both : later) = filter(frames, evidence, model, way == 1); });
  std::vector<std::vector<Association>> out(frames.size());
  inParallel(frames.size(), [&](std::size_t f) {
    for (std::size_t k = 0; k < both[f].size(); ++k)
      for (std::size_t i = 0; i < both[f][k].size(); ++i) both[f][k][i] *= later[f][k][i];
    out[f] = decide(evidence, f, model, both[f]);
  });
  return out;
}

// In order of time, measurements without a landmark keep the one of their last round (`last`), or get one of
// `weak` in gate, or initialise one, which later measurements in gate get. These landmarks join the known
// ones.
Decisions complete(const Frames& frames, const std::vector<std::vector<Association>>& associations,
                   const Decisions& last, const std::vector<Landmark>& weak, std::vector<Landmark>& landmarks,
                   LandmarkIdentity& identity, const MeasurementModel& model, double birth_existence) {
  const std::size_t known = landmarks.size();
  landmarks.insert(landmarks.end(), weak.begin(), weak.end());
  Decisions out;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    out.emplace_back();
    std::set<LandmarkId> taken;
    for (const auto& association : associations[f]) {
      out[f].push_back({association, association.landmark});
      LandmarkId& id = out[f].back().landmark;
      if (!id.valid() && !last.empty()) id = last[f][association.measurement].landmark;
      if (id.valid()) continue;
      const WorldMeasurement& seen = frames[f][association.measurement];
      double best = model.new_density_per_m2;
      for (std::size_t j = known; j < landmarks.size(); ++j) {
        if (!model.inGate(seen, landmarks[j]) || taken.contains(landmarks[j].id)) continue;
        const double density = birth_existence * model.density(seen, landmarks[j]);
        if (density > best) best = density, id = landmarks[j].id;
      }
      if (!id.valid()) {
        id = identity.create();
        landmarks.push_back(initializeLandmark(seen, id, birth_existence));
      }
      taken.insert(id);
    }
  }
  return out;
}

struct Sightings {
  std::vector<const WorldMeasurement*> seen;
  std::vector<double> weights;
};

std::map<LandmarkId, Sightings> byLandmark(const Frames& frames, const Decisions& decisions) {
  std::map<LandmarkId, Sightings> out;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    for (std::size_t k = 0; k < frames[f].size(); ++k) {
      auto& sightings = out[decisions[f][k].landmark];
      sightings.seen.push_back(&frames[f][k]);
      sightings.weights.push_back(sightingWeight(frames[f][k].measurement) *
                                  decisions[f][k].association.probability);
    }
  }
  return out;
}

std::optional<Split> twoObjects(const Landmark& landmark, const Sightings& sightings,
                                const DuplicateRule& rule) {
  std::vector<PlaceSketch> places;
  for (std::size_t i = 0; i < sightings.seen.size(); ++i) {
    const auto& seen = *sightings.seen[i];
    if (seen.measurement.proposal.class_name != landmark.class_name) continue;
    places.push_back({seen.world_from_object.translation().head<2>(),
                      std::sqrt(std::max(seen.covariance(0, 0), seen.covariance(1, 1))),
                      sightings.weights[i]});
  }
  return findSplit(places, rule.splitDistance(landmark.shape));
}

// Removes landmarks with few sightings, which get only sightings that fit no other landmark.
std::vector<Landmark> takeWeak(std::vector<Landmark>& landmarks) {
  const auto weak = std::stable_partition(landmarks.begin(), landmarks.end(), [](const Landmark& landmark) {
    return landmark.observations >= kLeastSightings;
  });
  std::vector<Landmark> out(weak, landmarks.end());
  landmarks.erase(weak, landmarks.end());
  return out;
}

// Estimates every landmark from its sightings; those without any are dropped.
void replace(const Frames& frames, const Decisions& decisions, std::vector<Landmark>& landmarks,
             const MeasurementModel& model) {
  const auto by_landmark = byLandmark(frames, decisions);
  std::erase_if(landmarks, [&](const Landmark& l) { return !by_landmark.contains(l.id); });
  for (auto& landmark : landmarks) {
    const Sightings& sightings = by_landmark.at(landmark.id);
    estimateLandmark(landmark, sightings.seen, sightings.weights, model);
  }
}

// Splits landmarks of two objects; the next round divides their sightings.
void splitMixed(const Frames& frames, const Decisions& decisions, std::vector<Landmark>& landmarks,
                LandmarkIdentity& identity, const DuplicateRule& rule) {
  const auto by_landmark = byLandmark(frames, decisions);
  const std::size_t known = landmarks.size();
  for (std::size_t j = 0; j < known; ++j) {
    const auto split = twoObjects(landmarks[j], by_landmark.at(landmarks[j].id), rule);
    if (!split) continue;
    Landmark other = landmarks[j];
    other.id = identity.split(landmarks[j].id);
    landmarks[j].position.head<2>() = split->first;
    other.position.head<2>() = split->second;
    landmarks.push_back(other);
  }
}

SeenTogether countTogether(const Decisions& decisions) {
  SeenTogether out;
  for (const auto& frame : decisions)
    for (const auto& a : frame)
      for (const auto& b : frame)
        if (a.landmark < b.landmark) ++out[{a.landmark, b.landmark}];
  return out;
}

// Merges duplicates: the landmark with more observations keeps its place and takes the other's sightings.
void joinDuplicates(const DuplicateRule& rule, Decisions& decisions, std::vector<Landmark>& landmarks,
                    LandmarkIdentity& identity) {
  const SeenTogether together = countTogether(decisions);
  std::stable_sort(landmarks.begin(), landmarks.end(),
                   [](const Landmark& a, const Landmark& b) { return a.observations > b.observations; });
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    for (std::size_t j = i + 1; j < landmarks.size();) {
      const auto pair = std::minmax(landmarks[i].id, landmarks[j].id);
      const auto count = together.find({pair.first, pair.second});
      if (!rule.same(landmarks[i], landmarks[j], count == together.end() ? 0 : count->second)) {
        ++j;
        continue;
      }
      identity.merge(landmarks[j].id, landmarks[i].id);
      landmarks[i].existence = 1 - (1 - landmarks[i].existence) * (1 - landmarks[j].existence);
      landmarks.erase(landmarks.begin() + static_cast<std::ptrdiff_t>(j));
    }
  }
  for (auto& frame : decisions)
    for (auto& decision : frame) decision.landmark = identity.today(decision.landmark);
  std::sort(landmarks.begin(), landmarks.end(),
            [](const Landmark& a, const Landmark& b) { return a.id < b.id; });
}

bool sameLandmarks(const Decisions& a, const Decisions& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return std::equal(x.begin(), x.end(), y.begin(), y.end(),
                      [](const auto& p, const auto& q) { return p.landmark == q.landmark; });
  });
}

// Posterior over the landmarks after merging; `first`: for the sighting that initialised its landmark.
void rename(BatchDecision& decision, const LandmarkIdentity& identity, bool first) {
  auto& association = decision.association;
  association.landmark = first ? LandmarkId{} : decision.landmark;
  association.posterior = renamed(association.posterior, [&](LandmarkId old) {
    const LandmarkId id = identity.today(old);
    // "New" was, at that time, the landmark that was created from it.
    return !id.valid() || id == decision.landmark ? association.landmark : id;
  });
  for (const auto& [id, probability] : association.posterior)
    if (id == association.landmark) association.probability = probability;
}

// First sightings are marked as new, as they were decided at the time.
void nameFirstSightings(Reassociation& result) {
  std::set<LandmarkId> known;
  for (auto& frame : result.decisions) {
    std::set<LandmarkId> now;
    for (auto& decision : frame) {
      rename(decision, result.identity, !known.contains(decision.landmark));
      now.insert(decision.landmark);
    }
    known.merge(now);
  }
}

}  // namespace

Reassociation reassociate(const Frames& by_frame, std::vector<Landmark> initial, LandmarkIdentity identity,
                          const AssociationModel& model, const LandmarkRules& rules, int max_rounds) {
  const OwnBoxes boxes = ownBoxes(by_frame, model.measurement);
  FeatureVotes votes(by_frame);
  const auto smoothed = [&](const std::vector<Landmark>& landmarks, const Decisions& last) {
    votes.count(last);
    return smooth(by_frame, gather(by_frame, boxes, votes, last, landmarks, model), model);
  };
  return reassociate(by_frame, std::move(initial), std::move(identity), smoothed, model.measurement, rules,
                     max_rounds);
}

DecideRun frameByFrame(Associator& associator, const Frames& by_frame) {
  return [&associator, &by_frame](const std::vector<Landmark>& landmarks, const Decisions&) {
    std::vector<std::vector<Association>> out;
    for (const auto& frame : by_frame) out.push_back(associator.associate(frame, landmarks));
    return out;
  };
}

Reassociation reassociate(const Frames& by_frame, std::vector<Landmark> initial, LandmarkIdentity identity,
                          const DecideRun& decide, const MeasurementModel& model, const LandmarkRules& rules,
                          int max_rounds) {
  Reassociation out;
  out.landmarks = std::move(initial);
  out.identity = std::move(identity);
  for (const auto& landmark : out.landmarks) out.identity.reserve(landmark.id);
  while (out.rounds < max_rounds && !out.settled) {
    ++out.rounds;
    // Landmarks are created, merged, split and dropped in the first half of the rounds only, so that the rest
    // converges.
    const bool open = out.rounds <= (max_rounds + 1) / 2;
    const std::vector<Landmark> weak = open ? takeWeak(out.landmarks) : std::vector<Landmark>{};
    const auto associations = decide(out.landmarks, out.decisions);
    Decisions decisions = complete(by_frame, associations, open ? Decisions{} : out.decisions, weak,
                                   out.landmarks, out.identity, model, rules.birth_existence);
    replace(by_frame, decisions, out.landmarks, model);
    if (open) joinDuplicates(rules.duplicates, decisions, out.landmarks, out.identity);
    out.settled = sameLandmarks(decisions, out.decisions);
    out.decisions = std::move(decisions);
    if (open && !out.settled)
      splitMixed(by_frame, out.decisions, out.landmarks, out.identity, rules.duplicates);
  }
  nameFirstSightings(out);
  return out;
}

}  // namespace roomgraph
