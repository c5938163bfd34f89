// SPDX-License-Identifier: BSD-3-Clause
// Table of the parameters of a calibration.
#include "roomgraph/calibration/sensor_parameters.h"

#include "roomgraph/geometry/degree.h"

namespace roomgraph {

const std::array<ParameterTraits, kParameterCount>& parameterTraits() {
  constexpr double kLength_m = 0.02, kAngle_rad = 1 * kDegree, kTime_s = 0.015, kShare = 0.02;
  static const std::array<ParameterTraits, kParameterCount> traits{{
      {"lidar x", "m", kLength_m},
      {"lidar y", "m", kLength_m},
      {"lidar yaw", "rad", kAngle_rad},
      {"camera x", "m", kLength_m},
      {"camera y", "m", kLength_m},
      {"camera z", "m", kLength_m},
      {"camera yaw", "rad", kAngle_rad},
      {"camera pitch", "rad", kAngle_rad},
      {"camera roll", "rad", kAngle_rad},
      {"camera time offset", "s", kTime_s},
      {"wheel time offset", "s", kTime_s},
      {"wheel scale", "", kShare},
      {"wheel turn scale", "", kShare},
      {"wheel heading drift", "rad/m", kShare},
      {"depth scale", "", kShare},
      {"depth bias", "m", kLength_m},
  }};
  return traits;
}

}  // namespace roomgraph
