// SPDX-License-Identifier: BSD-3-Clause
// LandmarkMap takes over a re-association: classes, existence and votes from all sightings, in the order of time.
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "roomgraph/association/landmark_map.h"

namespace roomgraph {
namespace {

// Landmarks with the frames that show them, as decided at last.
std::set<std::pair<LandmarkId, FrameId>> seenIn(const std::vector<std::vector<WorldMeasurement>>& by_frame,
                                                const Reassociation& result) {
  std::set<std::pair<LandmarkId, FrameId>> seen;
  for (std::size_t f = 0; f < by_frame.size(); ++f)
    for (std::size_t k = 0; k < by_frame[f].size(); ++k)
      seen.emplace(result.decisions[f][k].landmark, by_frame[f][k].measurement.frame);
  return seen;
}

}  // namespace

void LandmarkMap::adopt(const std::vector<std::vector<WorldMeasurement>>& by_frame,
                        const Reassociation& result, const std::vector<FormerSighting>& former) {
  const std::size_t known_changes = identity_.changes().size();
  identity_ = result.identity;
  for (std::size_t i = known_changes; i < identity_.changes().size(); ++i) {
    const auto& [kind, removed, kept] = identity_.changes()[i];
    if (kind == IdentityChange::Kind::kMerge && records_.contains(removed))
      joinRecords(records_[kept], records_[removed], false);
  }
  // Whoever is now said to be seen in a frame was not missed in it, though another one was taken for it then;
  // and of landmarks that were merged only one was missed.
  auto not_missed = seenIn(by_frame, result);
  for (const FormerSighting& sighting : former) not_missed.emplace(sighting.landmark, sighting.frame);
  std::multimap<FrameId, std::pair<LandmarkId, ExistenceUpdate>> existence_updates;
  for (const auto& landmark : result.landmarks)
    for (const ExistenceUpdate& update : records_[landmark.id].existence_updates)
      if (!update.missed_in.valid() || not_missed.emplace(landmark.id, update.missed_in).second)
        existence_updates.emplace(update.after, std::pair{landmark.id, update});
  // The sightings are fused again from the beginning, for existence and votes; then place and size are set to
  // those of the re-association.
  landmarks_ = result.landmarks;
  for (auto& landmark : landmarks_) {
    landmark.existence = rules().birth_existence;
    landmark.observations = 0;
  }
  records_.clear(), together_.clear(), in_frame_.clear();
  frame_ = {};
  classify(by_frame, result, former);
  auto next = existence_updates.begin();
  auto next_former = former.begin();
  const auto weighUntil = [&](FrameId frame) {
    for (; next != existence_updates.end() && next->first < frame; ++next) {
      countFormerUntil(next->first, next_former, former);
      const auto& [id, update] = next->second;
      updateExistence(id, update.log_ratio, update.missed_in);
      if (!update.missed_in.valid() && update.log_ratio > 0) records_[id].ray_support += update.log_ratio;
    }
    countFormerUntil(frame, next_former, former);
  };
  for (std::size_t f = 0; f < by_frame.size(); ++f) {
    if (!by_frame[f].empty()) weighUntil(by_frame[f].front().measurement.frame);
    for (std::size_t k = 0; k < by_frame[f].size(); ++k) {
      Association known = result.decisions[f][k].association;
      known.landmark = result.decisions[f][k].landmark;
      fuse(by_frame[f][k], known, true);
    }
  }
  weighUntil(FrameId{std::numeric_limits<std::int64_t>::max()});
  for (const auto& estimate : result.landmarks) {
    Landmark& landmark = *get(estimate.id);
    if (landmark.class_name == estimate.class_name) {
      correct(landmark.id, estimate.position, estimate.yaw, estimate.shape, estimate.covariance);
    }
  }
}

void LandmarkMap::classify(const std::vector<std::vector<WorldMeasurement>>& by_frame, const Reassociation& result,
                           const std::vector<FormerSighting>& former) {
  std::map<LandmarkId, std::map<std::string, double>> labels;
  std::map<std::pair<LandmarkId, std::string>, const WorldMeasurement*> first;
  for (const FormerSighting& sighting : former) labels[sighting.landmark][sighting.class_name] += sighting.weight;
  for (std::size_t f = 0; f < by_frame.size(); ++f)
    for (std::size_t k = 0; k < by_frame[f].size(); ++k) {
      const LandmarkId id = result.decisions[f][k].landmark;
      const ObjectMeasurement& measurement = by_frame[f][k].measurement;
      labels[id][measurement.proposal.class_name] += sightingWeight(measurement);
      first.try_emplace({id, measurement.proposal.class_name}, &by_frame[f][k]);
    }
  for (auto& landmark : landmarks_) {
    const auto& votes = labels[landmark.id];
    const auto most = std::max_element(votes.begin(), votes.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    if (most == votes.end() || most->second <= kClearMajority * labels[landmark.id][landmark.class_name]) continue;
    if (const auto seen = first.find({landmark.id, most->first}); seen != first.end())
      landmark = initializeLandmark(*seen->second, landmark.id, rules().birth_existence);
    landmark.observations = 0;
  }
}

// Of the former sightings, in order of time, those in frames before this one.
void LandmarkMap::countFormerUntil(FrameId frame, std::vector<FormerSighting>::const_iterator& next,
                                   const std::vector<FormerSighting>& former) {
  for (; next != former.end() && next->frame < frame; ++next) {
    Landmark* landmark = get(next->landmark);
    if (!landmark) continue;
    LandmarkRecord& record = records_[landmark->id];
    record.labels[next->class_name] += next->weight;
    if (next->class_name != landmark->class_name) continue;
    weigh(*landmark, std::exp(next->existence_log_ratio));
    ++landmark->observations;
    record.evidence += next->weight;
    countTogether(next->frame, landmark->id);
  }
}

}  // namespace roomgraph
