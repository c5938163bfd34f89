// SPDX-License-Identifier: BSD-3-Clause
// What a viewer says in words: about an object, and about the moment that is shown.
#pragma once

#include <string>
#include <vector>

#include "roomgraph/viewer/view_state.h"

namespace roomgraph {

/// A heading and lines under it.
struct TextBlock {
  std::string heading;
  std::vector<std::string> lines;
};

/// Class posterior, existence, size, place, sightings, and why it is there: the association and the energies
/// of the last sighting, and what speaks most for and against its existence. `start_t`: of the run, s.
std::vector<TextBlock> describeLandmark(const ShownLandmark& shown,
                                        const std::vector<ShownSighting>& sightings, double start_t);

/// Number of sightings in each of `parts` equal parts of the time between, as a share of the largest.
std::vector<float> sightingsOverTime(const std::vector<ShownSighting>& sightings, double from_t,
                                     double until_t, int parts);

/// "record 123, 12.3 s: 4 objects (7 candidates), 31 key poses, 2 loop closures", and what went wrong.
std::string describeMoment(const ViewState& state, double start_t);

/// "2×", "1/4×", "max".
std::string describeSpeed(double speed);

}  // namespace roomgraph
