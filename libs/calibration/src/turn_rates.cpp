// SPDX-License-Identifier: BSD-3-Clause
// Normalised cross-correlation over a grid of offsets, refined by a parabola.
#include "turn_rates.h"

#include <cmath>
#include <vector>

namespace roomgraph {
namespace {

constexpr double kLargest_s = 0.5, kStep_s = 0.01;
constexpr double kSampling_s = 0.02;
constexpr double kLeastRate_rad_s = 0.05;  // root mean square
constexpr int kLeastSamples = 100;
constexpr double kLeastCorrelation = 0.5;

struct Likeness {
  double correlation = 0, rate_rad_s = 0;
};

Likeness likeness(const TurnRate& reference, const TurnRate& moved, double from, double to, double offset) {
  double ab = 0, aa = 0, bb = 0;
  int count = 0;
  for (double t = from; t <= to; t += kSampling_s) {
    const auto a = reference(t);
    const auto b = a ? moved(t - offset) : std::nullopt;
    if (!b) continue;
    ab += *a * *b;
    aa += *a * *a;
    bb += *b * *b;
    ++count;
  }
  if (count < kLeastSamples || aa <= 0 || bb <= 0) return {};
  return {ab / std::sqrt(aa * bb), std::sqrt(aa / count)};
}

}  // namespace

std::optional<double> turnRateOffset(const TurnRate& reference, const TurnRate& moved, double from,
                                     double to) {
  const int steps = static_cast<int>(std::lround(kLargest_s / kStep_s));
  std::vector<Likeness> found;
  std::size_t best = 0;
  for (int i = -steps; i <= steps; ++i) {
    found.push_back(likeness(reference, moved, from, to, i * kStep_s));
    if (found.back().correlation > found[best].correlation) best = found.size() - 1;
  }
  if (found[best].correlation < kLeastCorrelation || found[best].rate_rad_s < kLeastRate_rad_s)
    return std::nullopt;
  double offset = (static_cast<int>(best) - steps) * kStep_s;
  if (best > 0 && best + 1 < found.size()) {
    const double a = found[best - 1].correlation, b = found[best].correlation,
                 c = found[best + 1].correlation;
    if (a - 2 * b + c < 0) offset += kStep_s * 0.5 * (a - c) / (a - 2 * b + c);
  }
  return offset;
}

}  // namespace roomgraph
