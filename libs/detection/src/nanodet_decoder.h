// SPDX-License-Identifier: BSD-3-Clause
// NanodetDecoder: boxes from the distance distributions of NanoDet-Plus.
#pragma once

#include "roomgraph/detection/network_decoder.h"

namespace roomgraph {

/// NanoDet-Plus (github.com/RangiLyu/nanodet): an output N x (C + 32) holds C class scores in [0, 1], then for the
/// left, top, right and bottom side the logits of 8 distances from the anchor, 0 to 7 strides; a distance is the
/// mean of its distribution. One row per anchor: strides 8, 16, 32, 64; anchor = (column, row) x stride.
class NanodetDecoder : public NetworkDecoder {
  DEFINE_MRPT_OBJECT(NanodetDecoder, roomgraph)
 public:
  std::string name() const override { return "nanodet"; }
  Preprocessing preprocessing() const override;
  bool recognises(const NetworkOutputs& outputs, int classes) const override;
  std::vector<RawBox> decode(const NetworkOutputs& outputs, const DecodingTask& task) const override;
};

}  // namespace roomgraph
