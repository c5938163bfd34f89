// SPDX-License-Identifier: BSD-3-Clause
// Floor and upright surfaces of a depth image, reduced to means over pixels.
#pragma once

#include <optional>

#include "evidence.h"
#include "roomgraph/geometry/ground.h"
#include "roomgraph/observations/frame.h"

namespace roomgraph {

/// Heights above the floor (m) between which upright surfaces are of interest.
struct HeightBand {
  double low_m = 0, high_m = 0;
};

/// `floor`: in the camera frame, as found in this image; nothing: none was found. `band`: nothing without a
/// lidar to compare with; heights by the frame's pose on the robot. The frame must have depth.
DepthView makeDepthView(const Frame& frame, const std::optional<Plane>& floor,
                        const std::optional<HeightBand>& band);

/// Median of the depths looked at, m; nothing when there are few.
std::optional<double> medianDepth(const Frame& frame);

}  // namespace roomgraph
