// SPDX-License-Identifier: BSD-3-Clause
// Grid index of features for search around a pixel.
#pragma once

#include <opencv2/core/types.hpp>

#include <cstdint>
#include <vector>

namespace roomgraph::tracking {

/// Where a feature is. A keyframe keeps hundreds of them for the rest of the run: cv::KeyPoint is more than twice as large.
struct FeaturePlace {
  cv::Point2f pt;           ///< px of the full image
  std::int32_t octave = 0;  ///< level of the pyramid
};

/// Index of features by image cell, for queries around a pixel.
class FeatureGrid {
 public:
  FeatureGrid() = default;
  FeatureGrid(const std::vector<FeaturePlace>& features, int width, int height);
  /// Appends the indices of features within radius (px) of (u, v), in a fixed order.
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
