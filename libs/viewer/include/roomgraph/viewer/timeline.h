// SPDX-License-Identifier: BSD-3-Clause
// Timeline: the states of a run in order, and which of them is shown.
#pragma once

#include <cstddef>
#include <vector>

#include "roomgraph/viewer/view_state.h"

namespace roomgraph {

/// The states so far. What is shown is the newest state until somebody goes back, and again when he comes to
/// the end.
class Timeline {
 public:
  /// Of more than `most` states the older ones are thinned out: of those in which nothing was sighted every
  /// second goes.
  explicit Timeline(std::size_t most = 40000) : most_(most) {}

  void add(const ViewStates& states);
  bool empty() const { return states_.empty(); }
  const ViewStates& states() const { return states_; }
  /// There must be a state.
  const ViewState& shown() const { return *states_[shown_]; }
  std::shared_ptr<const ViewState> shownPointer() const { return states_[shown_]; }
  const ViewState& newest() const { return *states_.back(); }
  bool atEnd() const { return states_.empty() || shown_ + 1 == states_.size(); }

  /// The last state that is not after that record, or that time, s; the first state when all are.
  void seekRecord(int record);
  void seekTime(double t);
  /// So many states on or back, as far as there are some.
  void move(int states);

  /// Sightings of a landmark up to the state that is shown, also under ids that it had before it was merged.
  std::vector<ShownSighting> sightingsOf(LandmarkId id) const;

 private:
  void thin();

  std::size_t most_, shown_ = 0;
  ViewStates states_;
};

}  // namespace roomgraph
