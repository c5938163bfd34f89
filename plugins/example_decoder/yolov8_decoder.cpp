// SPDX-License-Identifier: BSD-3-Clause
// Boxes of YOLOv8, registered when the plug-in is loaded.
#include "yolov8_decoder.h"

#include <mrpt/core/initializer.h>

#include "roomgraph/core/plugin.h"

ROOMGRAPH_PLUGIN()

namespace example {

IMPLEMENTS_MRPT_OBJECT(Yolov8Decoder, roomgraph::NetworkDecoder, example)

roomgraph::Preprocessing Yolov8Decoder::preprocessing() const {
  return {roomgraph::InputFit::kLetterboxTopLeft, 114};  // RGB in [0, 1]
}

bool Yolov8Decoder::recognises(const roomgraph::NetworkOutputs& outputs, int classes) const {
  const cv::Mat& blob = outputs.blobs.front();
  return blob.dims == 3 && blob.type() == CV_32FC1 && blob.size[0] == 1 && blob.size[1] == classes + 4;
}

std::vector<roomgraph::RawBox> Yolov8Decoder::decode(const roomgraph::NetworkOutputs& outputs,
                                                     const roomgraph::DecodingTask& task) const {
  std::vector<roomgraph::RawBox> boxes;
  if (!recognises(outputs, task.classes)) return boxes;
  const cv::Mat& blob = outputs.blobs.front();
  const auto value = [&](int row, int box) { return static_cast<double>(blob.at<float>(0, row, box)); };
  for (int box = 0; box < blob.size[2]; ++box) {
    int best = 0;
    for (int k = 1; k < task.classes; ++k)
      if (value(4 + k, box) > value(4 + best, box)) best = k;
    const double score = value(4 + best, box), u = value(0, box), v = value(1, box);
    const double half_width = value(2, box) / 2, half_height = value(3, box) / 2;
    if (score >= task.min_score && half_width > 0 && half_height > 0)
      boxes.push_back({{u - half_width, v - half_height, u + half_width, v + half_height}, best, score, {}});
  }
  return boxes;
}

}  // namespace example

// Runs when the library is loaded, before the networks are.
MRPT_INITIALIZER(registerExampleDecoder) {
  mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(Yolov8Decoder, example));
}
