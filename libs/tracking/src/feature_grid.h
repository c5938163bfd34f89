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
  struct Entry {
    cv::Point2f point;
    int index;
  };
  int columns_ = 0, rows_ = 0;
  std::vector<int> begins_;       ///< of each cell, row by row, in the entries, and the end of the last one
  std::vector<Entry> entries_;    ///< cell by cell, of a cell by index
};

}  // namespace roomgraph::tracking
