// SPDX-License-Identifier: BSD-3-Clause
// Non-maximum suppression of hypotheses by quality, with reasons for rejection.
#include "roomgraph/proposals/keep_best.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace roomgraph {
namespace {

bool sameAs(const PlacedShape& a, const PlacedShape& b, const SamePlace& same) {
  return std::hypot(a.x - b.x, a.y - b.y) < same.distance_m &&
         std::abs(wrapAngle(a.yaw - b.yaw)) < same.angle_rad;
}

std::string smallIou(double iou, double least) {
  char text[64];
  std::snprintf(text, sizeof text, "IoU with the box %.2f is below %.2f", iou, least);
  return text;
}

}  // namespace

std::vector<PlacedShape> keepBest(std::vector<PlacedShape> all, const SamePlace& same,
                                  const GeneratorLimits& limits) {
  std::stable_sort(all.begin(), all.end(),
                   [](const PlacedShape& a, const PlacedShape& b) { return a.quality > b.quality; });
  std::vector<PlacedShape> kept;
  for (PlacedShape& placed : all) {
    const bool known = std::any_of(kept.begin(), kept.end(),
                                   [&](const PlacedShape& k) { return sameAs(k, placed, same); });
    if (placed.box_iou < limits.min_iou) {
      placed.reason = smallIou(placed.box_iou, limits.min_iou);
    } else if (known) {
      placed.reason = "like a better one";
    } else if (static_cast<int>(kept.size()) == limits.max_count) {
      placed.reason = "enough better ones";
    } else {
      kept.push_back(std::move(placed));
      continue;
    }
    if (limits.rejected) limits.rejected->push_back(std::move(placed));
  }
  return kept;
}

}  // namespace roomgraph
