// SPDX-License-Identifier: BSD-3-Clause
// A median that is followed by small steps up and down.
#include "usual_roughness.h"

#include <algorithm>

#include "roomgraph/observations/roughness.h"

namespace roomgraph {
namespace {
constexpr double kStep = 1.01;
constexpr double kSmoothest_m = 1e-3;
}  // namespace

bool UsualRoughness::standsOut(const Scan& scan) {
  std::vector<float> returns_m = scan.ranges_m;
  for (std::size_t i = 0; i < returns_m.size(); ++i)
    if (!scan.valid[i]) returns_m[i] = 0;
  const double roughness_m = std::max(roughnessOfScan(returns_m), kSmoothest_m);
  if (!usual_m_) usual_m_ = roughness_m;
  const bool stands_out = roughness_m > roughnessLimit(*usual_m_);
  *usual_m_ *= roughness_m > *usual_m_ ? kStep : 1 / kStep;
  return stands_out;
}

}  // namespace roomgraph
