// SPDX-License-Identifier: BSD-3-Clause
// The grid that a map begins with.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

namespace roomgraph {

/// Unknown cells around the origin; MRPT's grid grows with what is inserted.
inline mrpt::maps::COccupancyGridMap2D::Ptr emptyGrid(double resolution_m) {
  constexpr float kHalfSize_m = 1;
  return mrpt::maps::COccupancyGridMap2D::Create(-kHalfSize_m, kHalfSize_m, -kHalfSize_m, kHalfSize_m,
                                                 static_cast<float>(resolution_m));
}

}  // namespace roomgraph
