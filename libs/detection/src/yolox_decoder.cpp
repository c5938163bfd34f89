// SPDX-License-Identifier: BSD-3-Clause
// Centre and size of YOLOX boxes, cell by cell.
#include "yolox_decoder.h"

#include <cmath>

#include "output_table.h"

namespace roomgraph {

IMPLEMENTS_MRPT_OBJECT(YoloxDecoder, NetworkDecoder, roomgraph)

Preprocessing YoloxDecoder::preprocessing() const {
  return {InputFit::kLetterboxTopLeft, 114, false, {}, cv::Scalar::all(1)};
}

bool YoloxDecoder::recognises(const NetworkOutputs& outputs, int classes) const {
  return outputs.file.extension() != ".weights" && columnsOf(outputs) == classes + 5;
}

std::vector<RawBox> YoloxDecoder::decode(const NetworkOutputs& outputs, const DecodingTask& task) const {
  std::vector<RawBox> boxes;
  const std::vector<GridCell> cells = gridCells({8, 16, 32}, outputs.input);
  for (const cv::Mat& blob : outputs.blobs) {
    const cv::Mat table = tableOf(blob);
    if (table.cols != task.classes + 5 || table.rows != static_cast<int>(cells.size())) continue;
    for (int i = 0; i < table.rows; ++i) {
      const float* row = table.ptr<float>(i);
      const BestClass best = bestOf(row + 5, task.classes);
      const double score = static_cast<double>(row[4]) * best.score;
      if (!(score >= task.min_score)) continue;
      const auto [cell_row, column, stride] = cells[i];
      const double u = (row[0] + column) * stride, v = (row[1] + cell_row) * stride;
      const double width = std::exp(row[2]) * stride, height = std::exp(row[3]) * stride;
      keepIfSound(boxes,
                  {{u - width / 2, v - height / 2, u + width / 2, v + height / 2}, best.index, score, {}});
    }
  }
  return boxes;
}

}  // namespace roomgraph
