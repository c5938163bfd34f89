// SPDX-License-Identifier: BSD-3-Clause
// Places of map points, used again.
#include "point_store.h"

namespace roomgraph::tracking {

MapPoint& PointStore::add() {
  if (size_ % kPage == 0) pages_.push_back(std::make_unique<Page>());
  if (free_.empty()) {
    free_.push_back(static_cast<std::int32_t>(points_.size()));
    points_.emplace_back();
  }
  const std::int32_t place = free_.back();
  free_.pop_back();
  pages_.back()->places[size_++ % kPage] = place;
  return points_[static_cast<std::size_t>(place)];
}

void PointStore::release(std::size_t id) {
  const std::int32_t place = placeOf(id);
  if (place == kReleased) return;
  points_[static_cast<std::size_t>(place)] = {};
  free_.push_back(place);
  auto& page = pages_[id / kPage];
  page->places[id % kPage] = kReleased;
  if (++page->released == kPage) page.reset();
}

}  // namespace roomgraph::tracking
