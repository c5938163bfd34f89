// SPDX-License-Identifier: BSD-3-Clause
// Weight of a sighting in means of places.
#pragma once

#include <algorithm>

#include "roomgraph/backend/factors.h"

namespace roomgraph {

/// However doubtful, a sighting has some weight.
inline double weightOf(const LandmarkFactor& sighting) {
  return std::max(sighting.weight, 1e-9);
}

/// By the weight and the variance of the place, 1/m^2.
inline double shareOfPlace(const LandmarkFactor& sighting) {
  return weightOf(sighting) / sighting.covariance.topLeftCorner<2, 2>().trace();
}

}  // namespace roomgraph
