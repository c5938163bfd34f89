// SPDX-License-Identifier: BSD-3-Clause
// Places of map points, used again.
#include "point_store.h"

namespace roomgraph::tracking {

MapPoint& PointStore::add() {
  if (free_.empty()) {
    places_.push_back(static_cast<std::int32_t>(points_.size()));
    return points_.emplace_back();
  }
  places_.push_back(free_.back());
  free_.pop_back();
  return points_[at(size() - 1)];
}

void PointStore::release(std::size_t id) {
  if (places_[id] == kReleased) return;
  points_[at(id)] = {};
  free_.push_back(places_[id]);
  places_[id] = kReleased;
}

}  // namespace roomgraph::tracking
