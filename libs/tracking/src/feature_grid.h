// SPDX-License-Identifier: BSD-3-Clause
// Grid index of keypoints for search around a pixel.
#pragma once

#include <opencv2/core/types.hpp>

#include <vector>

namespace roomgraph::tracking {

/// Index of keypoints by image cell, for queries around a pixel.
class FeatureGrid {
 public:
  FeatureGrid() = default;
  FeatureGrid(const std::vector<cv::KeyPoint>& keypoints, int width, int height);
  /// Appends the indices of keypoints within radius (px) of (u, v), in a fixed order.
  void query(double u, double v, double radius, std::vector<int>& out) const;

 private:
  static constexpr int kCellPx = 16;
  int columns_ = 0, rows_ = 0;
  std::vector<std::vector<int>> cells_;
  std::vector<cv::Point2f> points_;
};

}  // namespace roomgraph::tracking
