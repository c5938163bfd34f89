// SPDX-License-Identifier: BSD-3-Clause
// Example plug-in: decoder of YOLOv8 networks.
#pragma once

#include "roomgraph/detection/network_decoder.h"

namespace example {

/// YOLOv8 as its authors export it to ONNX (docs.ultralytics.com): one output 1 x (4 + C) x N, a column per box:
/// centre and size in pixels of the input, then C class scores in [0, 1].
class Yolov8Decoder : public roomgraph::NetworkDecoder {
  DEFINE_MRPT_OBJECT(Yolov8Decoder, example)
 public:
  std::string name() const override { return "yolov8"; }
  roomgraph::Preprocessing preprocessing() const override;
  bool recognises(const roomgraph::NetworkOutputs& outputs, int classes) const override;
  std::vector<roomgraph::RawBox> decode(const roomgraph::NetworkOutputs& outputs,
                                        const roomgraph::DecodingTask& task) const override;
};

}  // namespace example
