// SPDX-License-Identifier: BSD-3-Clause
// Position in the list of states, thinning, and collection of sightings.
#include "roomgraph/viewer/timeline.h"

#include <algorithm>

namespace roomgraph {

void Timeline::add(const ViewStates& states) {
  const bool follow = atEnd();
  states_.insert(states_.end(), states.begin(), states.end());
  if (states_.size() > most_) thin();
  if (follow && !states_.empty()) shown_ = states_.size() - 1;
}

void Timeline::thin() {
  const std::shared_ptr<const ViewState> shown = states_[shown_];
  ViewStates kept;
  bool drop = false;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const bool may_go = i < states_.size() / 2 && states_[i]->sightings.empty() && states_[i] != shown;
    drop = may_go && !drop;
    if (!drop) kept.push_back(states_[i]);
  }
  states_ = std::move(kept);
  shown_ = static_cast<std::size_t>(std::find(states_.begin(), states_.end(), shown) - states_.begin());
}

void Timeline::seekRecord(int record) {
  const auto after = std::partition_point(states_.begin(), states_.end(),
                                          [&](const auto& state) { return state->record <= record; });
  shown_ = static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - states_.begin() - 1, 0));
}

void Timeline::seekTime(double t) {
  const auto after =
      std::partition_point(states_.begin(), states_.end(), [&](const auto& state) { return state->t <= t; });
  shown_ = static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - states_.begin() - 1, 0));
}

void Timeline::move(int states) {
  if (states_.empty()) return;
  const auto last = static_cast<std::ptrdiff_t>(states_.size()) - 1;
  shown_ = static_cast<std::size_t>(
      std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(shown_) + states, 0, last));
}

std::vector<ShownSighting> Timeline::sightingsOf(LandmarkId id) const {
  std::vector<ShownSighting> out;
  if (states_.empty()) return out;
  if (const auto& all = shown().all_sightings) {
    for (const auto& sighting : *all)
      if (sighting.landmark == id && sighting.t <= shown().t) out.push_back(sighting);
    return out;
  }
  const auto& identity = shown().identity;
  for (std::size_t i = 0; i <= shown_; ++i)
    for (const auto& sighting : states_[i]->sightings)
      if ((identity ? identity->today(sighting.landmark) : sighting.landmark) == id) out.push_back(sighting);
  return out;
}

}  // namespace roomgraph
