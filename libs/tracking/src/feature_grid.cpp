// SPDX-License-Identifier: BSD-3-Clause
// Bucketed keypoints and radius queries.
#include "feature_grid.h"

#include <algorithm>
#include <cmath>

namespace roomgraph::tracking {

FeatureGrid::FeatureGrid(const std::vector<cv::KeyPoint>& keypoints, int width, int height)
    : columns_((width + kCellPx - 1) / kCellPx), rows_((height + kCellPx - 1) / kCellPx) {
  cells_.resize(static_cast<std::size_t>(columns_ * rows_));
  points_.reserve(keypoints.size());
  for (std::size_t i = 0; i < keypoints.size(); ++i) {
    const cv::Point2f& p = keypoints[i].pt;
    points_.push_back(p);
    const int c = std::clamp(static_cast<int>(p.x) / kCellPx, 0, columns_ - 1);
    const int r = std::clamp(static_cast<int>(p.y) / kCellPx, 0, rows_ - 1);
    cells_[static_cast<std::size_t>(r * columns_ + c)].push_back(static_cast<int>(i));
  }
}

void FeatureGrid::query(double u, double v, double radius, std::vector<int>& out) const {
  if (columns_ == 0) return;
  const auto cell = [](double x, int count) {
    return std::clamp(static_cast<int>(std::floor(x / kCellPx)), 0, count - 1);
  };
  const int c0 = cell(u - radius, columns_), c1 = cell(u + radius, columns_);
  const int r0 = cell(v - radius, rows_), r1 = cell(v + radius, rows_);
  for (int r = r0; r <= r1; ++r)
    for (int c = c0; c <= c1; ++c)
      for (const int i : cells_[static_cast<std::size_t>(r * columns_ + c)]) {
        const double du = points_[static_cast<std::size_t>(i)].x - u,
                     dv = points_[static_cast<std::size_t>(i)].y - v;
        if (du * du + dv * dv <= radius * radius) out.push_back(i);
      }
}

}  // namespace roomgraph::tracking
