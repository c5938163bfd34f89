// SPDX-License-Identifier: BSD-3-Clause
// Bounded memory for decoding of embedded and external images.
#pragma once

#include <mrpt/obs/CObservation3DRangeScan.h>

namespace roomgraph {

/// From now on a thread with an AllocationLimit cannot make an OpenCV image of more than 256 MB: pictures are
/// compressed, so that a damaged size in a JPEG's header could ask for gigabytes whatever the record's
/// length.
void countImageMemory();

/// Loads external images (observation.load()) with bounded memory. Throws std::exception when they cannot be
/// read or are too large.
void loadImages(mrpt::obs::CObservation3DRangeScan& observation);

}  // namespace roomgraph
