// SPDX-License-Identifier: BSD-3-Clause
// Small states, landmarks and sightings for tests of the viewer.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "roomgraph/viewer/view_state.h"
#include "sample_map.h"

namespace roomgraph::test {

inline constexpr double kBegin_t = 1700000000;

inline std::shared_ptr<const ShownLandmark> shownLandmark(const Landmark& landmark, bool in_map = true) {
  return std::make_shared<const ShownLandmark>(ShownLandmark{landmark, in_map, {}});
}

inline ShownSighting sightingAt(std::int64_t landmark, double seconds, double probability = 0.95) {
  return {.landmark = LandmarkId{landmark},
          .t = kBegin_t + seconds,
          .probability = probability,
          .confidence = 0.8,
          .score = 0.6,
          .energy = {1.25, -0.5, 0.125},
          .posterior = {{LandmarkId{landmark}, probability}, {LandmarkId{}, 1 - probability}},
          .source = "depth"};
}

/// One state a second: record n at n seconds, the robot n metres along x.
inline std::shared_ptr<ViewState> stateAt(int record) {
  auto state = std::make_shared<ViewState>();
  state->record = record;
  state->t = kBegin_t + record;
  state->world_from_robot = poseFromYpr(record, 0, 0, 0, 0, 0);
  state->landmarks = std::make_shared<const ShownLandmarks>();
  return state;
}

inline ViewStates statesFromTo(int first, int last) {
  ViewStates states;
  for (int record = first; record <= last; ++record) states.push_back(stateAt(record));
  return states;
}

}  // namespace roomgraph::test
