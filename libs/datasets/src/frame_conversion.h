// SPDX-License-Identifier: BSD-3-Clause
// Conversion of an MRPT RGB-D record into a Frame: undistorted, registered, in metres.
#pragma once

#include <mrpt/obs/CObservation3DRangeScan.h>

#include <string>

#include "roomgraph/core/outcome.h"
#include "roomgraph/observations/frame.h"

namespace roomgraph {

/// Frame of an RGB-D record: undistorted, depth registered to colour, metres. The failure's reason says what
/// is missing ("image missing: <file>", "no camera intrinsics", …). `image_folder`: where external images
/// are.
Outcome<Frame> toFrame(mrpt::obs::CObservation3DRangeScan& observation, const std::string& image_folder);

/// Intrinsics for an image of the given size, which must have the calibration's aspect ratio (otherwise, or
/// without focal length, an invalid camera). The distortion is that of the calibration.
PinholeCamera cameraForImage(const mrpt::img::TCamera& calibration, int width, int height);

/// True when colour and depth image have one camera in common: same place, same intrinsics, same size.
bool depthIsRegistered(const mrpt::obs::CObservation3DRangeScan& observation, const PinholeCamera& color,
                       const PinholeCamera& depth);

/// External file the record needs that does not exist; empty when there is none.
std::string missingExternalFile(const mrpt::obs::CObservation3DRangeScan& observation,
                                const std::string& image_folder);

}  // namespace roomgraph
