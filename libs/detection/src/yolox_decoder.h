// SPDX-License-Identifier: BSD-3-Clause
// YoloxDecoder: boxes from the grid offsets of YOLOX.
#pragma once

#include "roomgraph/detection/network_decoder.h"

namespace roomgraph {

/// YOLOX (github.com/Megvii-BaseDetection/YOLOX): an output N x (5 + C) holds the box centre less its cell (in
/// strides), the logarithm of the size (in strides), objectness and C class scores; score = objectness x class
/// score. One row per cell: strides 8, 16, 32.
class YoloxDecoder : public NetworkDecoder {
  DEFINE_MRPT_OBJECT(YoloxDecoder, roomgraph)
 public:
  std::string name() const override { return "yolox"; }
  Preprocessing preprocessing() const override;
  bool recognises(const NetworkOutputs& outputs, int classes) const override;
  std::vector<RawBox> decode(const NetworkOutputs& outputs, const DecodingTask& task) const override;
};

}  // namespace roomgraph
