// SPDX-License-Identifier: BSD-3-Clause
// Table of the parameters of a calibration.
#include "roomgraph/calibration/sensor_parameters.h"

#include "roomgraph/geometry/degree.h"

namespace roomgraph {

const std::array<ParameterTraits, kParameterCount>& parameterTraits() {
  constexpr double kLength_m = 0.02, kAngle_rad = 1 * kDegree, kTime_s = 0.015, kShare = 0.02;
  constexpr double kUneven_m = 0.001, kUneven_rad = 0.02 * kDegree, kClock_s = 0.0002, kLeft = 0.0005;
  constexpr double kSlips = 0.008, kSteps = 0.0008, kSteps_m = 0.0022;
  static const std::array<ParameterTraits, kParameterCount> traits{{
      {"lidar x", "m", kLength_m, kUneven_m},
      {"lidar y", "m", kLength_m, kUneven_m},
      {"lidar yaw", "rad", kAngle_rad, kUneven_rad},
      {"camera x", "m", kLength_m, kUneven_m},
      {"camera y", "m", kLength_m, kUneven_m},
      {"camera z", "m", kLength_m, kUneven_m},
      {"camera yaw", "rad", kAngle_rad, kUneven_rad},
      {"camera pitch", "rad", kAngle_rad, kUneven_rad},
      {"camera roll", "rad", kAngle_rad, kUneven_rad},
      {"camera time offset", "s", kTime_s, kClock_s},
      {"wheel time offset", "s", kTime_s, kClock_s},
      {"wheel scale", "", kShare, kSlips},
      {"wheel turn scale", "", kShare, kLeft},
      {"wheel heading drift", "rad/m", kShare, kLeft},
      {"depth scale", "", kShare, kSteps},
      {"depth bias", "m", kLength_m, kSteps_m},
  }};
  return traits;
}

}  // namespace roomgraph
