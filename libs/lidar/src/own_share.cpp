// SPDX-License-Identifier: BSD-3-Clause
// Variance of differences between neighbours against their variance.
#include "own_share.h"

#include <algorithm>

namespace roomgraph {

NeighbourErrors neighbourErrors(const Points2& points, const std::vector<LineError>& errors) {
  constexpr double kSameSurface = 0.9;  // cosine between normals
  NeighbourErrors out;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const LineError &a = errors[i - 1], &b = errors[i];
    if (!a.known || !b.known || a.normal.dot(b.normal) < kSameSurface) continue;
    if ((points[i] - points[i - 1]).squaredNorm() > kAlike_m * kAlike_m) continue;
    out.apart += (a.sigmas - b.sigmas) * (a.sigmas - b.sigmas) / 2;
    out.all += (a.sigmas * a.sigmas + b.sigmas * b.sigmas) / 2;
  }
  return out;
}

double OwnShare::value() const {
  constexpr double kLeast = 0.02;
  return std::clamp(apart_ / all_, kLeast, 1.0);
}

void OwnShare::learn(const NeighbourErrors& errors) {
  constexpr double kKept = 0.98;
  if (errors.all <= 0) return;
  apart_ = kKept * apart_ + errors.apart;
  all_ = kKept * all_ + errors.all;
}

}  // namespace roomgraph
