// SPDX-License-Identifier: BSD-3-Clause
// Non-maximum suppression of hypotheses by quality, with reasons for rejection.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "generators.h"

namespace roomgraph {
namespace {

bool sameAs(const PlacedShape& a, const PlacedShape& b, double distance, double angle) {
  return std::hypot(a.x - b.x, a.y - b.y) < distance && std::abs(wrapAngle(a.yaw - b.yaw)) < angle;
}

std::string smallIou(double iou, double least) {
  char text[64];
  std::snprintf(text, sizeof text, "IoU with the box %.2f is below %.2f", iou, least);
  return text;
}

}  // namespace

std::vector<PlacedShape> keepBest(std::vector<PlacedShape> all, double distance, double angle,
                                  const GeneratorLimits& limits) {
  std::stable_sort(all.begin(), all.end(),
                   [](const PlacedShape& a, const PlacedShape& b) { return a.quality > b.quality; });
  std::vector<PlacedShape> kept;
  for (PlacedShape& placed : all) {
    const bool known = std::any_of(kept.begin(), kept.end(),
                                   [&](const PlacedShape& k) { return sameAs(k, placed, distance, angle); });
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
