// SPDX-License-Identifier: BSD-3-Clause
// Decoder of the room detector that training/ makes: six-channel input, boxes by their sides' distances.
#pragma once

#include "roomgraph/detection/network_decoder.h"

namespace roomgraph {

/// Cells of strides 8, 16 and 32, row by row; a cell has a logit per class, then the logarithms of the
/// distances of the box's left, top, right and bottom sides from the cell's centre, in strides, and three
/// more values (training/network.py).
class RoomDecoder : public NetworkDecoder {
  DEFINE_MRPT_OBJECT(RoomDecoder, roomgraph)
 public:
  std::string name() const override { return "room"; }
  Preprocessing preprocessing() const override { return {}; }
  bool usesDepth() const override { return true; }
  bool recognises(const NetworkOutputs& outputs, int classes) const override;
  std::vector<RawBox> decode(const NetworkOutputs& outputs, const DecodingTask& task) const override;
};

}  // namespace roomgraph
