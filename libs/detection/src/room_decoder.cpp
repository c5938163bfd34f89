// SPDX-License-Identifier: BSD-3-Clause
// Scores and boxes of the room detector, cell by cell.
#include "room_decoder.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "output_table.h"

namespace roomgraph {

IMPLEMENTS_MRPT_OBJECT(RoomDecoder, NetworkDecoder, roomgraph)

namespace {
constexpr std::size_t kSides = 4;
constexpr std::size_t kExtras = 3;  // distance and front, which the training gains from; not read
}  // namespace

bool RoomDecoder::recognises(const NetworkOutputs& outputs, int classes) const {
  return outputs.file.extension() == ".onnx" && columnsOf(outputs) == classes + static_cast<int>(kSides + kExtras) &&
         tableOf(outputs.blobs[0]).rows == static_cast<int>(gridCells({8, 16, 32}, outputs.input).size());
}

std::vector<RawBox> RoomDecoder::decode(const NetworkOutputs& outputs, const DecodingTask& task) const {
  constexpr float kLongest = 5;  // logarithm of 148 strides: what is longer is an error
  std::vector<RawBox> boxes;
  if (!recognises(outputs, task.classes)) return boxes;
  const cv::Mat table = tableOf(outputs.blobs[0]);
  const std::vector<GridCell> cells = gridCells({8, 16, 32}, outputs.input);
  for (int i = 0; i < table.rows; ++i) {
    const float* row = table.ptr<float>(i);
    const BestClass best = bestOf(row, task.classes);
    const double score = 1 / (1 + std::exp(-static_cast<double>(best.score)));
    if (!(score >= task.min_score)) continue;
    const auto [cell_row, column, stride] = cells[static_cast<std::size_t>(i)];
    std::array<double, kSides> side;
    for (std::size_t k = 0; k < kSides; ++k)
      side[k] =
          stride *
          std::exp(static_cast<double>(std::min(row[static_cast<std::size_t>(task.classes) + k], kLongest)));
    const double u = (column + 0.5) * stride, v = (cell_row + 0.5) * stride;
    keepIfSound(boxes, {{u - side[0], v - side[1], u + side[2], v + side[3]}, best.index, score, {}});
  }
  return boxes;
}

}  // namespace roomgraph
