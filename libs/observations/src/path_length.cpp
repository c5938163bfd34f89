// SPDX-License-Identifier: BSD-3-Clause
// Sum of the steps that were driven.
#include "roomgraph/observations/path_length.h"

namespace roomgraph {

double pathLength(const std::vector<StampedPose>& path) {
  double length_m = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const double step = (path[i].pose.translation() - path[i - 1].pose.translation()).norm();
    if (step < kSessionGap_m) length_m += step;
  }
  return length_m;
}

}  // namespace roomgraph
