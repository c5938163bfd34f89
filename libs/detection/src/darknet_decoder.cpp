// SPDX-License-Identifier: BSD-3-Clause
// Relative boxes of Darknet's region layers in pixels.
#include "darknet_decoder.h"

#include "output_table.h"

namespace roomgraph {

IMPLEMENTS_MRPT_OBJECT(DarknetDecoder, NetworkDecoder, roomgraph)

Preprocessing DarknetDecoder::preprocessing() const {
  return {};
}

bool DarknetDecoder::recognises(const NetworkOutputs& outputs, int classes) const {
  return outputs.file.extension() == ".weights" && columnsOf(outputs) == classes + 5;
}

std::vector<RawBox> DarknetDecoder::decode(const NetworkOutputs& outputs, const DecodingTask& task) const {
  std::vector<RawBox> boxes;
  for (const cv::Mat& blob : outputs.blobs) {
    const cv::Mat table = tableOf(blob);
    if (table.cols != task.classes + 5) continue;
    for (int i = 0; i < table.rows; ++i) {
      const float* row = table.ptr<float>(i);
      const BestClass best = bestOf(row + 5, task.classes);
      if (!(best.score >= task.min_score)) continue;
      const double u = row[0] * outputs.input.width, v = row[1] * outputs.input.height;
      const double width = row[2] * outputs.input.width, height = row[3] * outputs.input.height;
      keepIfSound(
          boxes,
          {{u - width / 2, v - height / 2, u + width / 2, v + height / 2}, best.index, best.score, {}});
    }
  }
  return boxes;
}

}  // namespace roomgraph
