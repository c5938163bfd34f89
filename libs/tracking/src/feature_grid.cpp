// SPDX-License-Identifier: BSD-3-Clause
// Bucketed features and radius queries.
#include "feature_grid.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace roomgraph::tracking {

FeatureGrid::FeatureGrid(const std::vector<FeaturePlace>& features, int width, int height)
    : columns_((width + kCellPx - 1) / kCellPx), rows_((height + kCellPx - 1) / kCellPx) {
  const auto cellOf = [this](const cv::Point2f& p) {
    const int c = std::clamp(static_cast<int>(p.x) / kCellPx, 0, columns_ - 1);
    const int r = std::clamp(static_cast<int>(p.y) / kCellPx, 0, rows_ - 1);
    return static_cast<std::size_t>(r * columns_ + c);
  };
  begins_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
  for (const auto& feature : features) ++begins_[cellOf(feature.pt) + 1];
  std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
  std::vector<int> next(begins_.begin(), begins_.end() - 1);
  entries_.resize(features.size());
  for (std::size_t i = 0; i < features.size(); ++i) {
    const cv::Point2f& p = features[i].pt;
    entries_[static_cast<std::size_t>(next[cellOf(p)]++)] = {p, static_cast<int>(i)};
  }
}

void FeatureGrid::query(double u, double v, double radius, std::vector<int>& out) const {
  if (columns_ == 0) return;
  const auto cell = [](double x, int count) {
    return std::clamp(static_cast<int>(std::floor(x / kCellPx)), 0, count - 1);
  };
  const int c0 = cell(u - radius, columns_), c1 = cell(u + radius, columns_);
  const int r0 = cell(v - radius, rows_), r1 = cell(v + radius, rows_);
  for (int r = r0; r <= r1; ++r) {
    // The cells of a row follow each other.
    const auto row = static_cast<std::size_t>(r * columns_);
    const auto begin = static_cast<std::size_t>(begins_[row + static_cast<std::size_t>(c0)]);
    const auto end = static_cast<std::size_t>(begins_[row + static_cast<std::size_t>(c1) + 1]);
    for (std::size_t i = begin; i < end; ++i) {
      const Entry& entry = entries_[i];
      const double du = entry.point.x - u, dv = entry.point.y - v;
      if (du * du + dv * dv <= radius * radius) out.push_back(entry.index);
    }
  }
}

}  // namespace roomgraph::tracking
