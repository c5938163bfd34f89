// SPDX-License-Identifier: BSD-3-Clause
// One correction after another as one.
#pragma once

#include "roomgraph/datasets/calibration_file.h"

namespace roomgraph {

/// What does the same as `first` and then `second`.
WheelCorrection composed(const WheelCorrection& first, const WheelCorrection& second);
DepthCorrection composed(const DepthCorrection& first, const DepthCorrection& second);

}  // namespace roomgraph
