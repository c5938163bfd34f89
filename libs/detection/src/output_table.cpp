// SPDX-License-Identifier: BSD-3-Clause
// Views of network outputs and anchors of a grid pyramid.
#include "output_table.h"

#include <algorithm>
#include <cmath>

namespace roomgraph {

cv::Mat tableOf(const cv::Mat& blob) {
  if (blob.type() != CV_32FC1) return {};
  if (blob.dims == 3 && blob.size[0] == 1)
    return cv::Mat(blob.size[1], blob.size[2], CV_32FC1, const_cast<uchar*>(blob.data));
  return blob.dims == 2 ? blob : cv::Mat();
}

int columnsOf(const NetworkOutputs& outputs) {
  return tableOf(outputs.blobs.front()).cols;
}

BestClass bestOf(const float* scores, int count) {
  const float* best = std::max_element(scores, scores + count);
  return {static_cast<int>(best - scores), *best};
}

std::vector<GridCell> gridCells(const std::vector<int>& strides, cv::Size input) {
  std::vector<GridCell> cells;
  for (const int stride : strides) {
    const int rows = (input.height + stride - 1) / stride, columns = (input.width + stride - 1) / stride;
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) cells.push_back({row, column, stride});
  }
  return cells;
}

void keepIfSound(std::vector<RawBox>& boxes, const RawBox& box) {
  const bool finite = std::isfinite(box.box.u_min) && std::isfinite(box.box.v_min) &&
                      std::isfinite(box.box.u_max) && std::isfinite(box.box.v_max);
  if (finite && !box.box.empty()) boxes.push_back(box);
}

}  // namespace roomgraph
