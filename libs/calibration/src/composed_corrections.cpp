// SPDX-License-Identifier: BSD-3-Clause
// Corrections of wheels and depths are linear, and so is what two of them do.
#include "composed_corrections.h"

namespace roomgraph {

WheelCorrection composed(const WheelCorrection& first, const WheelCorrection& second) {
  // Length and angle (s, a) become (scale s, turn_scale a + drift scale s), twice.
  return {first.scale * second.scale, first.turn_scale * second.turn_scale,
          second.turn_scale * first.drift_rad_m / second.scale + second.drift_rad_m};
}

DepthCorrection composed(const DepthCorrection& first, const DepthCorrection& second) {
  return {second.scale * first.scale, second.scale * first.bias_m + second.bias_m};
}

}  // namespace roomgraph
