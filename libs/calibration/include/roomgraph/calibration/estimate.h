// SPDX-License-Identifier: BSD-3-Clause
// Result of the estimation of a calibration.
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "roomgraph/calibration/sensor_parameters.h"

namespace roomgraph {

enum class Knowledge {
  kFixed,    ///< by the data
  kPartly,   ///< only together with other parameters
  kUnfixed,  ///< nothing in the data says it: as it was before
  kHeld      ///< not asked for, or given by the choice of frame: as it was before
};

struct CalibrationEstimate {
  ParameterVector before = ParameterVector::Zero(), after = ParameterVector::Zero();
  /// Of `after`. Of what is not fixed: what the data and the weak belief in the former value leave.
  ParameterMatrix covariance = ParameterMatrix::Zero();
  std::array<Knowledge, kParameterCount> knowledge{};
  /// Combinations of parameters about which the data say nothing, in words.
  std::vector<std::string> unfixed;
  std::map<std::string, int> measurements;  ///< used, by kind
  std::map<std::string, double> noise;      ///< by kind: scatter over what is usual
  double sigma(int parameter) const { return std::sqrt(covariance(parameter, parameter)); }
};

}  // namespace roomgraph
