// SPDX-License-Identifier: BSD-3-Clause
// LandmarkIdentity: ids of landmarks over a run, with all merges and splits.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "roomgraph/core/ids.h"

namespace roomgraph {

/// Probabilities or weights of landmarks; the invalid id stands for a new landmark.
using WeightedLandmarks = std::vector<std::pair<LandmarkId, double>>;

/// A merge (`from` was removed, `to` was kept) or a split (`from` was kept, `to` was created for its second
/// part).
struct IdentityChange {
  enum class Kind { kMerge, kSplit } kind = Kind::kMerge;
  LandmarkId from, to;
};

/// Which landmark ids exist and which of them denote the same object. Stored ids are resolved with today(). A split
/// cannot be resolved by id alone, because sightings are divided by position: stored sightings are updated with
/// changes(). An id is never used twice.
class LandmarkIdentity {
 public:
  /// An id that no landmark has had.
  LandmarkId create() { return LandmarkId{next_++}; }
  /// Reserves an id that was created elsewhere.
  void reserve(LandmarkId id) { next_ = std::max(next_, id.value + 1); }

  /// Records that the landmarks are one object. Throws std::logic_error when one of them was merged before, or both are
  /// the same.
  void merge(LandmarkId removed, LandmarkId kept);
  /// Records that the landmark is two objects; returns the id created for the second.
  LandmarkId split(LandmarkId id);

  /// Id after all merges so far; unchanged for ids that were never merged, and for the invalid one.
  LandmarkId today(LandmarkId id) const;
  /// All merges and splits in the order in which they happened.
  const std::vector<IdentityChange>& changes() const { return changes_; }

 private:
  std::int64_t next_ = 0;
  std::map<LandmarkId, LandmarkId> today_;  // of merged ids only; one step leads to the end
  std::vector<IdentityChange> changes_;
};

/// The weights with every id replaced by `rename(id)`; weights of ids that become equal are added, at most to
/// 1, at the position of the first of them.
WeightedLandmarks renamed(const WeightedLandmarks& weights,
                          const std::function<LandmarkId(LandmarkId)>& rename);

}  // namespace roomgraph
