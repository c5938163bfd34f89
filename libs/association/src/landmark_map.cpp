// SPDX-License-Identifier: BSD-3-Clause
// Bernoulli existence filter, fusion, merging, splitting and confirmation of landmarks.
#include "roomgraph/association/landmark_map.h"

#include <algorithm>
#include <cmath>

#include "roomgraph/geometry/covariance.h"

namespace roomgraph {
namespace {

constexpr int kMaxRays = 20;
constexpr double kPrecise_m = 0.3;  // standard deviation on the ground up to which a sighting counts fully

constexpr double kUnderAnother = 0.5;  // share of the footprint of a chair that may be under a table
constexpr double kMovedVariance_m2 = 0.01;  // of a place that the next sightings or the graph will tell

bool opposite(double a, double b) {
  return std::abs(wrapAngle(a - b)) > M_PI / 2;
}

}  // namespace

const Landmark* LandmarkMap::find(LandmarkId id) const {
  for (const auto& landmark : landmarks_)
    if (landmark.id == id) return &landmark;
  return nullptr;
}

Landmark* LandmarkMap::get(LandmarkId id) {
  return const_cast<Landmark*>(find(id));
}

// Likelihood ratio of "exists" against "does not" for a sighting. It is nearer to 1 for boxes carried from an
// earlier frame and for places of large variance, and 1 for a place that does not fit the landmark.
double LandmarkMap::likelihoodRatio(const Landmark& landmark, const WorldMeasurement& seen) const {
  const ObjectMeasurement& measurement = seen.measurement;
  double share =
      measurement.proposal.score > 0 ? sightingWeight(measurement) / measurement.proposal.score : 1;
  const double variance = seen.covariance.topLeftCorner<2, 2>().trace();
  share *= std::min(1.0, kPrecise_m * kPrecise_m / variance);
  if (isElsewhere(landmark, seen)) share = 0;
  // Below the neutral score the evidence fades to none: a score of 0 means that only a box was seen.
  const double score = measurement.proposal.score;
  if (score < options_.neutral_score) share *= score / options_.neutral_score;
  return std::exp(options_.score_gain * share * (score - options_.neutral_score));
}

LandmarkId LandmarkMap::update(const WorldMeasurement& seen, const Association& association) {
  return fuse(seen, association, false);
}

LandmarkId LandmarkMap::fuse(const WorldMeasurement& seen, const Association& association, bool class_is_known) {
  const ObjectMeasurement& measurement = seen.measurement;
  Landmark* landmark = get(association.landmark);
  const bool is_new = landmark == nullptr;
  if (is_new) {
    landmarks_.push_back(initializeLandmark(seen, identity_.create(), rules().birth_existence));
    landmark = &landmarks_.back();
  }
  LandmarkRecord& record = records_[landmark->id];
  voteLabel(*landmark, record, measurement);
  const std::string& label = measurement.proposal.class_name;
  if (label != landmark->class_name) {
    if (class_is_known || record.labels[label] <= kClearMajority * record.labels[landmark->class_name]) return landmark->id;
    const Landmark before = *landmark;
    *landmark = initializeLandmark(seen, before.id, before.existence);
    landmark->class_posterior = before.class_posterior;
    landmark->observations = before.observations;
    record.size_weight = record.front = record.back = 0;  // of what it was taken for
    record.recent.clear();
  } else if (!is_new) {
    weigh(*landmark, likelihoodRatio(*landmark, seen));
    fusePlace(*landmark, seen);
    ++landmark->observations;
  }
  fuseSize(*landmark, record, measurement);
  voteYaw(*landmark, record, seen);
  remember(record, seen);
  record.evidence += sightingWeight(measurement);
  countTogether(measurement.frame, landmark->id);
  return landmark->id;
}

void LandmarkMap::countTogether(FrameId frame, LandmarkId id) {
  if (frame != frame_ || !frame.valid()) in_frame_.clear();
  frame_ = frame;
  const Landmark& landmark = *find(id);
  for (const auto other_id : in_frame_) {
    const Landmark* other = find(other_id);
    if (!other || other_id == id) continue;
    // Pairs far apart are never duplicates and need no counting.
    const double near = 2 * std::max(landmark.shape.horizontalExtent(), other->shape.horizontalExtent());
    if ((other->position - landmark.position).head<2>().norm() < near)
      ++together_[{std::min(id, other_id), std::max(id, other_id)}];
  }
  in_frame_.push_back(id);
}

int LandmarkMap::together(LandmarkId a, LandmarkId b) const {
  const auto found = together_.find({std::min(a, b), std::max(a, b)});
  return found == together_.end() ? 0 : found->second;
}

// Bayes' rule with the likelihood ratio of "exists" against "does not".
void LandmarkMap::weigh(Landmark& landmark, double ratio) const {
  const double exists = ratio * landmark.existence;
  // Clamped, so that existence can recover: a hidden object may be seen again, one seen for long may be
  // removed.
  landmark.existence = std::clamp(exists / (exists + 1 - landmark.existence), 0.01, 1 - 1e-9);
}

void LandmarkMap::updateExistence(LandmarkId id, double log_ratio, FrameId missed_in) {
  Landmark* landmark = get(id);
  if (!landmark) return;
  weigh(*landmark, std::exp(log_ratio));
  records_[id].existence_updates.push_back({frame_, log_ratio, missed_in});
}

void LandmarkMap::miss(LandmarkId id, FrameId frame) {
  updateExistence(id, std::log((1 - options_.detection_probability) / (1 - options_.false_alarm_probability)),
                  frame);
}

void LandmarkMap::seenThrough(LandmarkId id, int rays) {
  updateExistence(id, -options_.ray_gain * std::clamp(rays, 0, kMaxRays));
}

void LandmarkMap::supported(LandmarkId id, int rays) {
  if (!find(id)) return;
  // Returns show that something is there, but not its class: their total support is limited.
  double& support = records_[id].ray_support;
  const double before = support;
  support = std::min(before + options_.ray_gain * std::clamp(rays, 0, kMaxRays), kMaxRaySupport);
  if (support > before) updateExistence(id, support - before);
}

double LandmarkMap::existenceLogRatio(LandmarkId id, const WorldMeasurement& sighting) const {
  const Landmark* landmark = find(id);
  if (!landmark || sighting.measurement.proposal.class_name != landmark->class_name) return 0;
  return std::log(likelihoodRatio(*landmark, sighting));
}

void LandmarkMap::correct(LandmarkId id, const Eigen::Vector3d& position, double yaw,
                          const ObjectShape& shape, const Eigen::Matrix4d& covariance) {
  Landmark* landmark = get(id);
  if (!landmark) return;
  LandmarkRecord& record = records_[id];
  for (auto& sighting : record.recent) sighting.place += (position - landmark->position).head<2>();
  if (opposite(yaw, landmark->yaw)) std::swap(record.front, record.back);
  landmark->position = position;
  landmark->yaw = yaw;
  landmark->shape = shape;
  landmark->covariance = covariance;
}

void LandmarkMap::move(LandmarkId id, const Pose3& new_from_old) {
  Landmark* landmark = get(id);
  if (!landmark) return;
  for (auto& sighting : records_[id].recent)
    sighting.place = (new_from_old * Eigen::Vector3d(sighting.place.x(), sighting.place.y(), 0)).head<2>();
  const Pose3 moved = new_from_old * landmark->worldFromObject();
  landmark->position = moved.translation();
  landmark->yaw = planarPart(moved).yaw;
  landmark->covariance = rotateCovariance(landmark->covariance, new_from_old.linear());
}

// Place and size are those of the landmark with more observations.
void LandmarkMap::join(Landmark& kept, const Landmark& removed) {
  const LandmarkId id = kept.id;
  const double existence = 1 - (1 - kept.existence) * (1 - removed.existence);
  const int observations = kept.observations + removed.observations;
  joinRecords(records_[id], records_[removed.id], opposite(kept.yaw, removed.yaw));
  if (removed.observations > kept.observations) {
    if (opposite(kept.yaw, removed.yaw)) std::swap(records_[id].front, records_[id].back);
    kept = removed;
  }
  kept.id = id;
  kept.existence = existence;
  kept.observations = observations;
  records_.erase(removed.id);
  SeenTogether renamed;
  for (const auto& [pair, count] : together_) {
    const LandmarkId a = pair.first == removed.id ? id : pair.first;
    const LandmarkId b = pair.second == removed.id ? id : pair.second;
    if (a != b) renamed[{std::min(a, b), std::max(a, b)}] += count;
  }
  together_ = std::move(renamed);
}

void LandmarkMap::merge(std::size_t kept, std::size_t removed) {
  identity_.merge(landmarks_[removed].id, landmarks_[kept].id);
  join(landmarks_[kept], Landmark(landmarks_[removed]));
  landmarks_.erase(landmarks_.begin() + static_cast<std::ptrdiff_t>(removed));
}

void LandmarkMap::setMoved(LandmarkId id, std::optional<LandmarkId> same, const Eigen::Vector2d& place) {
  const auto at = [this](LandmarkId sought) {
    return static_cast<std::size_t>(std::find_if(landmarks_.begin(), landmarks_.end(), [&](const Landmark& l) { return l.id == sought; }) - landmarks_.begin());
  };
  if (same) merge(at(id), at(*same));
  Landmark& landmark = landmarks_.at(at(id));
  landmark.position.head<2>() = place;
  landmark.covariance.topLeftCorner<2, 2>() += kMovedVariance_m2 * Eigen::Matrix2d::Identity();
  LandmarkRecord& record = records_[id];  // all of what rays and misses said is of where it stood before
  record.recent.clear(), record.existence_updates.clear();
  record.ray_support = 0;
}

std::vector<std::pair<LandmarkId, LandmarkId>> LandmarkMap::mergeDuplicates() {
  std::vector<std::pair<LandmarkId, LandmarkId>> merged;
  for (std::size_t i = 0; i < landmarks_.size(); ++i) {
    for (std::size_t j = i + 1; j < landmarks_.size();) {
      const int together_seen = together(landmarks_[i].id, landmarks_[j].id);
      if (!rules().duplicates.same(landmarks_[i], landmarks_[j], together_seen)) {
        ++j;
        continue;
      }
      merged.emplace_back(landmarks_[j].id, landmarks_[i].id);
      merge(i, j);
    }
  }
  return merged;
}

std::vector<std::pair<LandmarkId, LandmarkId>> LandmarkMap::splitMixed() {
  std::vector<std::pair<LandmarkId, LandmarkId>> split_pairs;
  const std::size_t known = landmarks_.size();
  for (std::size_t i = 0; i < known; ++i) {
    Landmark& landmark = landmarks_[i];
    LandmarkRecord& record = records_[landmark.id];
    const std::vector<PlaceSketch> sightings(record.recent.begin(), record.recent.end());
    const auto split = findSplit(sightings, rules().duplicates.splitDistance(landmark.shape));
    if (!split) continue;
    Landmark made = landmark;
    made.id = identity_.split(landmark.id);
    landmark.position.head<2>() = split->first;
    made.position.head<2>() = split->second;
    made.observations = static_cast<int>(std::lround(split->second_share * landmark.observations));
    landmark.observations -= made.observations;
    LandmarkRecord& other = records_[made.id] = record;
    other.evidence *= split->second_share;
    record.evidence -= other.evidence;
    record.recent.clear(), other.recent.clear();
    for (std::size_t k = 0; k < sightings.size(); ++k)
      (split->is_second[k] ? other : record).recent.push_back(sightings[k]);
    split_pairs.emplace_back(landmark.id, made.id);
    landmarks_.push_back(made);
  }
  return split_pairs;
}

void LandmarkMap::rename(LandmarkId own, LandmarkId earlier) {
  Landmark* landmark = get(own);
  if (!landmark) return;
  landmark->id = earlier;
  identity_.merge(own, earlier);
  auto record = records_.extract(own);
  record.key() = earlier;
  records_.insert(std::move(record));
  SeenTogether renamed;
  for (const auto& [pair, count] : together_) {
    const LandmarkId a = pair.first == own ? earlier : pair.first,
                     b = pair.second == own ? earlier : pair.second;
    renamed[{std::min(a, b), std::max(a, b)}] += count;
  }
  together_ = std::move(renamed);
  std::sort(landmarks_.begin(), landmarks_.end(),
            [](const Landmark& a, const Landmark& b) { return a.id < b.id; });
}

double LandmarkMap::weightOf(LandmarkId id) const {
  const auto found = records_.find(id);
  return found == records_.end() ? 0 : found->second.evidence;
}

bool LandmarkMap::isConfirmed(const Landmark& landmark) const {
  return landmark.existence >= options_.confirm_existence &&
         landmark.observations >= options_.confirm_observations;
}

std::vector<Landmark> LandmarkMap::confirmed() const {
  std::vector<Landmark> sure;
  for (const auto& landmark : landmarks_)
    if (isConfirmed(landmark)) sure.push_back(landmark);
  return exclusive(std::move(sure));
}

// Two objects cannot overlap: of overlapping landmarks (e.g. a sofa sometimes labelled chair) the one with
// more evidence stays. Things of two classes that frames show beside each other may reach under each other, as chairs do at a
// table.
std::vector<Landmark> LandmarkMap::exclusive(std::vector<Landmark> landmarks) const {
  std::stable_sort(landmarks.begin(), landmarks.end(), [this](const Landmark& a, const Landmark& b) {
    return records_.at(a.id).evidence > records_.at(b.id).evidence;
  });
  std::vector<Landmark> kept;
  for (const auto& landmark : landmarks) {
    const bool free = std::none_of(kept.begin(), kept.end(), [&](const Landmark& other) {
      const bool may_reach_under = landmark.class_name != other.class_name &&
                                   rules().duplicates.seenApart(landmark, other, together(landmark.id, other.id));
      const double most = may_reach_under ? std::max(kUnderAnother, options_.exclusive_overlap) : options_.exclusive_overlap;
      return footprintOverlap(landmark.shape, landmark.worldFromObject(), other.shape, other.worldFromObject()) > most;
    });
    if (free) kept.push_back(landmark);
  }
  std::sort(kept.begin(), kept.end(), [](const Landmark& a, const Landmark& b) { return a.id < b.id; });
  return kept;
}

}  // namespace roomgraph
