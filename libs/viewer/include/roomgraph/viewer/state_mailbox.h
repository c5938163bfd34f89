// SPDX-License-Identifier: BSD-3-Clause
// StateMailbox: hand-over of what to show from the thread that maps to the one that draws.
#pragma once

#include <memory>
#include <mutex>
#include <utility>

#include "roomgraph/viewer/view_state.h"

namespace roomgraph {

/// Every state arrives; of the frames, which hold images, only the newest. Neither side waits for the other
/// but for the exchange of pointers.
class StateMailbox {
 public:
  struct Content {
    ViewStates states;                       ///< in the order in which they were put in
    std::shared_ptr<const SeenFrame> frame;  ///< null: none since the last time
  };

  /// `frame` null: the state has none.
  void put(std::shared_ptr<const ViewState> state, std::shared_ptr<const SeenFrame> frame = nullptr) {
    const std::lock_guard lock(mutex_);
    content_.states.push_back(std::move(state));
    if (frame) std::swap(content_.frame, frame);  // the old one is destroyed after the lock is
  }
  /// All since the last time.
  Content take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(content_, {});
  }

 private:
  std::mutex mutex_;
  Content content_;
};

}  // namespace roomgraph
