// SPDX-License-Identifier: BSD-3-Clause
// Weighted sum of the area, edge and depth parts of the initialisation score.
#include "initial_score.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "find_edges.h"

namespace roomgraph {
namespace {

constexpr double kFullArea = 0.08;  // of the image; from here on the area part is 1
constexpr double kAreaWeight = 0.4, kEdgeWeight = 0.25, kDepthWeight = 0.35;  // method.md sec. 1.5

}  // namespace

std::string InitialScore::text() const {
  char buffer[96];
  std::snprintf(buffer, sizeof buffer, "area %.2f, edges %.2f, depth %.2f", area, edges, depth);
  return buffer;
}

InitialScore initialScore(const BoxEvidence& evidence) {
  InitialScore out;
  const Box2& box = evidence.box;
  if (box.empty()) return out;
  out.area =
      std::min(1.0, std::sqrt(box.area() / (kFullArea * evidence.camera.width * evidence.camera.height)));
  out.edges = std::min(1.0, totalLength(evidence.segments) / (2 * (box.width() + box.height())));
  out.depth = std::clamp(evidence.mask.valid_ratio, 0.0, 1.0);
  out.value = kAreaWeight * out.area + kEdgeWeight * out.edges + kDepthWeight * out.depth;
  return out;
}

}  // namespace roomgraph
