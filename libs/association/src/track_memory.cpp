// SPDX-License-Identifier: BSD-3-Clause
// Forgetting of track posteriors and lookup of feature owners.
#include "track_memory.h"

#include <algorithm>
#include <cmath>

namespace roomgraph {
namespace {

constexpr double kMemory_s = 5;              // tracks not seen for so long are dropped
constexpr std::size_t kMaxFeatures = 50000;  // the oldest points are dropped first

}  // namespace

TrackMemory::Key TrackMemory::keyOf(const ObjectMeasurement& measurement) {
  const bool chained = measurement.track.valid();
  return {chained, chained ? measurement.track.value : measurement.detection.track.value};
}

std::vector<double> TrackMemory::prior(const ObjectMeasurement& measurement,
                                       const std::vector<LandmarkId>& ids, double forgetting) const {
  const double even = 1.0 / static_cast<double>(ids.size());
  std::vector<double> out(ids.size(), even);
  const auto past = tracks_.find(keyOf(measurement));
  if (past == tracks_.end() || std::abs(measurement.t - past->second.t) > kMemory_s) return out;
  // Of the later one of both frames.
  const double beta = backwards_ ? past->second.beta : measurement.beta;
  const double kept = (1 - forgetting) * std::clamp(beta, 0.0, 1.0);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const auto found = past->second.posterior.find(ids[i]);
    out[i] = kept * (found == past->second.posterior.end() ? 0 : found->second) + (1 - kept) * even;
  }
  return out;
}

void TrackMemory::remember(const ObjectMeasurement& measurement, const WeightedLandmarks& posterior) {
  std::erase_if(tracks_,
                [&](const auto& entry) { return std::abs(measurement.t - entry.second.t) > kMemory_s; });
  const Key key = keyOf(measurement);
  if (key.second < 0) return;
  Past& past = tracks_[key];
  past.t = measurement.t;
  past.beta = measurement.beta;
  past.posterior.clear();
  for (const auto& [id, probability] : posterior) past.posterior[id] += probability;
}

void TrackMemory::named(const ObjectMeasurement& measurement, LandmarkId landmark) {
  const auto past = tracks_.find(keyOf(measurement));
  if (past == tracks_.end()) return;
  auto& posterior = past->second.posterior;
  const auto fresh = posterior.find(LandmarkId{});
  if (fresh == posterior.end() || posterior.contains(landmark)) return;
  posterior[landmark] += fresh->second;
  posterior.erase(fresh);
}

void TrackMemory::resolve(const LandmarkIdentity& identity) {
  for (auto& [key, past] : tracks_) {
    std::map<LandmarkId, double> resolved;
    for (const auto& [id, probability] : past.posterior) resolved[identity.today(id)] += probability;
    past.posterior = std::move(resolved);
  }
}

void FeatureOwners::own(const std::vector<std::int64_t>& features, LandmarkId landmark) {
  for (const auto feature : features) owners_[feature] = landmark;
  while (owners_.size() > kMaxFeatures) owners_.erase(owners_.begin());
}

void FeatureOwners::resolve(const LandmarkIdentity& identity) {
  for (auto& [feature, owner] : owners_) owner = identity.today(owner);
}

std::vector<double> FeatureOwners::shares(const std::vector<std::int64_t>& features,
                                          const std::vector<LandmarkId>& ids, double weight) const {
  const double even = 1.0 / static_cast<double>(ids.size());
  std::map<LandmarkId, double> owned;
  double total = weight;
  for (const auto feature : features) {
    const auto owner = owners_.find(feature);
    if (owner == owners_.end()) continue;
    owned[owner->second] += 1;
    total += 1;
  }
  std::vector<double> out;
  for (const auto id : ids) out.push_back((owned[id] + weight * even) / total);
  return out;
}

}  // namespace roomgraph
