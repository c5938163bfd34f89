// SPDX-License-Identifier: BSD-3-Clause
// Douglas-Peucker without recursion, and binning of a series.
#include "path_thinning.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace roomgraph {
namespace {

constexpr double kFinest_m = 0.01;
constexpr std::size_t kBlock = 4096;  // the effort grows with the square of a block at worst

double distanceToSegment(const PathPoint& p, const PathPoint& a, const PathPoint& b) {
  const double dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
  const double along = length2 > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / length2, 0., 1.) : 0;
  return std::hypot(p.x - a.x - along * dx, p.y - a.y - along * dy);
}

void keepWithin(const std::vector<PathPoint>& path, std::size_t first, std::size_t last, double tolerance_m,
                std::vector<bool>& keep) {
  std::vector<std::pair<std::size_t, std::size_t>> open{{first, last}};
  while (!open.empty()) {
    const auto [begin, end] = open.back();
    open.pop_back();
    double farthest_m = tolerance_m;
    std::size_t at = begin;
    for (std::size_t i = begin + 1; i < end; ++i)
      if (const double distance_m = distanceToSegment(path[i], path[begin], path[end]);
          distance_m > farthest_m) {
        farthest_m = distance_m;
        at = i;
      }
    if (at == begin) continue;
    keep[at] = true;
    open.insert(open.end(), {{begin, at}, {at, end}});
  }
}

}  // namespace

std::vector<std::size_t> keptPoints(const std::vector<PathPoint>& path, double tolerance_m) {
  std::vector<bool> keep(path.size(), false);
  for (std::size_t begin = 0; begin < path.size(); begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, path.size() - 1);
    keep[begin] = keep[end] = true;
    keepWithin(path, begin, end, tolerance_m, keep);
  }
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < path.size(); ++i)
    if (keep[i]) kept.push_back(i);
  return kept;
}

std::vector<PathPoint> thinned(const std::vector<PathPoint>& path, std::size_t most) {
  std::vector<std::size_t> kept;
  for (double tolerance_m = kFinest_m; tolerance_m < 1e4; tolerance_m *= 2) {
    kept = keptPoints(path, tolerance_m);
    if (kept.size() <= most) break;
  }
  std::vector<PathPoint> out;
  for (const std::size_t i : kept) out.push_back(path[i]);
  return out;
}

int partsFor(std::size_t values, int most) {
  return std::max(1, static_cast<int>(std::min(values / 2, static_cast<std::size_t>(most))));
}

BinnedSeries binned(const std::vector<std::pair<double, double>>& values, double from, double to, int bins) {
  const auto count = static_cast<std::size_t>(bins);
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  BinnedSeries out{from, to > from ? (to - from) / bins : 1, std::vector(count, kNone),
                   std::vector(count, kNone)};
  for (const auto& [t, value] : values) {
    if (!(t >= from && t <= to) || !std::isfinite(value)) continue;
    const std::size_t bin = std::min(count - 1, static_cast<std::size_t>((t - from) / out.step));
    out.low[bin] = std::fmin(out.low[bin], value);
    out.high[bin] = std::fmax(out.high[bin], value);
  }
  return out;
}

}  // namespace roomgraph
