// SPDX-License-Identifier: BSD-3-Clause
// What decoders of box detectors have in common: outputs as tables, anchors of a grid pyramid, sound boxes.
#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>
#include <vector>

#include "roomgraph/detection/network_decoder.h"

namespace roomgraph {

/// N x C view of a blob 1 x N x C or N x C of 32-bit floats; empty for any other blob.
cv::Mat tableOf(const cv::Mat& blob);

/// Columns of the network's first output as a table; 0 when it is none.
int columnsOf(const NetworkOutputs& outputs);

/// The class with the largest of `count` scores, and that score.
struct BestClass {
  int index = -1;
  float score = 0;
};
BestClass bestOf(const float* scores, int count);

/// One anchor of a grid pyramid.
struct GridCell {
  int row = 0, column = 0;
  int stride = 0;  ///< px of the input
};

/// The anchors of a network with one grid per stride, row by row, stride after stride: row n of its output
/// belongs to cell n.
std::vector<GridCell> gridCells(const std::vector<int>& strides, cv::Size input);

/// Adds the box unless a side is not finite or it is empty.
void keepIfSound(std::vector<RawBox>& boxes, const RawBox& box);

}  // namespace roomgraph
