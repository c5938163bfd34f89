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

// From where the line that is left is at the time of p: who looks up a time finds the place, too.
double distanceAtItsTime(const PathPoint& p, const PathPoint& a, const PathPoint& b) {
  const double share = b.t > a.t ? (p.t - a.t) / (b.t - a.t) : 0;
  return std::hypot(p.x - a.x - share * (b.x - a.x), p.y - a.y - share * (b.y - a.y));
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
      if (const double distance_m = distanceAtItsTime(path[i], path[begin], path[end]);
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

std::vector<std::size_t> keptPoints(const std::vector<PathPoint>& path, double tolerance_m, double longest_s) {
  std::vector<bool> keep(path.size(), false);
  for (std::size_t begin = 0, end = 0; begin < path.size(); begin = end) {
    for (end = begin + 1; end < path.size() && end < begin + kBlock; ++end)
      if (path[end].t - path[end - 1].t > longest_s) break;
    keep[begin] = keep[end - 1] = true;
    keepWithin(path, begin, end - 1, tolerance_m, keep);
  }
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < path.size(); ++i)
    if (keep[i]) kept.push_back(i);
  return kept;
}

std::vector<PathPoint> thinned(const std::vector<PathPoint>& path, std::size_t most, double longest_s) {
  std::vector<std::size_t> kept;
  for (double tolerance_m = kFinest_m; tolerance_m < 1e4; tolerance_m *= 2) {
    kept = keptPoints(path, tolerance_m, longest_s);
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
