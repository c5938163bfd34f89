// SPDX-License-Identifier: BSD-3-Clause
// DarknetDecoder: boxes from the region layers of Darknet networks.
#pragma once

#include "roomgraph/detection/network_decoder.h"

namespace roomgraph {

/// Darknet networks (YOLOv3, YOLOv4, Yolo-Fastest …) as OpenCV runs them: every output N x (5 + C) holds box centre
/// and size relative to the input, objectness, and C class scores that are multiplied by it already.
class DarknetDecoder : public NetworkDecoder {
  DEFINE_MRPT_OBJECT(DarknetDecoder, roomgraph)
 public:
  std::string name() const override { return "darknet"; }
  Preprocessing preprocessing() const override;
  bool recognises(const NetworkOutputs& outputs, int classes) const override;
  std::vector<RawBox> decode(const NetworkOutputs& outputs, const DecodingTask& task) const override;
};

}  // namespace roomgraph
