// SPDX-License-Identifier: BSD-3-Clause
// Mean distances of the four sides of NanoDet boxes, anchor by anchor.
#include "nanodet_decoder.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "output_table.h"

namespace roomgraph {

IMPLEMENTS_MRPT_OBJECT(NanodetDecoder, NetworkDecoder, roomgraph)

namespace {

constexpr int kDistances = 8;  // 0 to 7 strides, per side

// Mean of a distribution over 0, 1, 2 … that is given by its logits (softmax).
double meanOfLogits(const float* logits, int count) {
  const float top = *std::max_element(logits, logits + count);
  double sum = 0, weighted = 0;
  for (int i = 0; i < count; ++i) {
    const double p = std::exp(static_cast<double>(logits[i] - top));
    sum += p;
    weighted += i * p;
  }
  return weighted / sum;
}

}  // namespace

// Mean and standard deviation of ImageNet's colours, as in its training.
Preprocessing NanodetDecoder::preprocessing() const {
  return {InputFit::kStretch, 0, false, {103.53, 116.28, 123.675}, {57.375, 57.12, 58.395}};
}

bool NanodetDecoder::recognises(const NetworkOutputs& outputs, int classes) const {
  return outputs.file.extension() != ".weights" && columnsOf(outputs) == classes + 4 * kDistances;
}

std::vector<RawBox> NanodetDecoder::decode(const NetworkOutputs& outputs, const DecodingTask& task) const {
  std::vector<RawBox> boxes;
  const std::vector<GridCell> cells = gridCells({8, 16, 32, 64}, outputs.input);
  for (const cv::Mat& blob : outputs.blobs) {
    const cv::Mat table = tableOf(blob);
    if (table.cols != task.classes + 4 * kDistances || table.rows != static_cast<int>(cells.size())) continue;
    for (int i = 0; i < table.rows; ++i) {
      const float* row = table.ptr<float>(i);
      const BestClass best = bestOf(row, task.classes);
      if (!(best.score >= task.min_score)) continue;
      const auto [cell_row, column, stride] = cells[i];
      std::array<double, 4> side;  // px from the anchor to the left, top, right, bottom
      for (int k = 0; k < 4; ++k) side[k] = stride * meanOfLogits(row + task.classes + k * kDistances, kDistances);
      const double u = column * stride, v = cell_row * stride;
      keepIfSound(boxes, {{u - side[0], v - side[1], u + side[2], v + side[3]}, best.index, best.score, {}});
    }
  }
  return boxes;
}

}  // namespace roomgraph
