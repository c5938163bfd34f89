// SPDX-License-Identifier: BSD-3-Clause
// Time offsets to begin with, from turn rates.
#pragma once

#include "calibration_problem.h"

namespace roomgraph {

/// Adds what turn rates say of the time offsets of camera and wheels, where these are asked for. Returns
/// those about which they say nothing: too little turning.
std::bitset<kParameterCount> addCoarseOffsets(const CalibrationTask& task, ParameterVector& values);

}  // namespace roomgraph
