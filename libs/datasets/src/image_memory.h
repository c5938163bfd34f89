// SPDX-License-Identifier: BSD-3-Clause
// Bounded memory for external images.
#pragma once

#include <mrpt/obs/CObservation3DRangeScan.h>

namespace roomgraph {

/// Loads external images (observation.load()) with bounded memory. Throws std::exception when they cannot be
/// read or are too large.
void loadImages(mrpt::obs::CObservation3DRangeScan& observation);

}  // namespace roomgraph
