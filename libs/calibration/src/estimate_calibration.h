// SPDX-License-Identifier: BSD-3-Clause
// Estimation of a calibration from the evidence of recordings.
#pragma once

#include <functional>

#include "calibration_problem.h"
#include "roomgraph/calibration/estimate.h"

namespace roomgraph {

/// Coarse time offsets, then least squares with walls matched again, each time by the calibration found so
/// far. What the evidence does not fix keeps its former value. `progress` gets the share done. Throws
/// RunError without any evidence.
CalibrationEstimate estimateCalibration(const CalibrationTask& given,
                                        const std::function<void(double)>& progress = nullptr);

}  // namespace roomgraph
