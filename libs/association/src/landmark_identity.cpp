// SPDX-License-Identifier: BSD-3-Clause
// Record of merges with paths of length one, and renaming of weights.
#include "roomgraph/association/landmark_identity.h"

#include <algorithm>
#include <stdexcept>

namespace roomgraph {

void LandmarkIdentity::merge(LandmarkId removed, LandmarkId kept) {
  if (removed == kept || today_.contains(removed) || today_.contains(kept))
    throw std::logic_error("LandmarkIdentity: only landmarks that exist today can be merged");
  for (auto& [old, now] : today_)
    if (now == removed) now = kept;
  today_[removed] = kept;
  changes_.push_back({IdentityChange::Kind::kMerge, removed, kept});
}

LandmarkId LandmarkIdentity::split(LandmarkId id) {
  changes_.push_back({IdentityChange::Kind::kSplit, id, create()});
  return changes_.back().to;
}

LandmarkId LandmarkIdentity::today(LandmarkId id) const {
  const auto found = today_.find(id);
  return found == today_.end() ? id : found->second;
}

WeightedLandmarks renamed(const WeightedLandmarks& weights,
                          const std::function<LandmarkId(LandmarkId)>& rename) {
  WeightedLandmarks out;
  for (const auto& [old, weight] : weights) {
    const LandmarkId id = rename(old);
    const auto same =
        std::find_if(out.begin(), out.end(), [id](const auto& entry) { return entry.first == id; });
    if (same == out.end()) {
      out.emplace_back(id, weight);
    } else {
      same->second =
          std::min(1.0, same->second + weight);  // the sum of probabilities may exceed 1 by rounding
    }
  }
  return out;
}

}  // namespace roomgraph
