// SPDX-License-Identifier: BSD-3-Clause
// Ade20kDecoder: boxes and masks from the logits of a semantic segmentation.
#pragma once

#include "roomgraph/detection/network_decoder.h"

namespace roomgraph {

/// Semantic segmentation, as the networks trained on ADE20K: logits 1 x C x H x W. One box per 8-connected
/// component of pixels whose largest logit is that of a wanted class, with its mask; score = mean softmax
/// probability of the class over the component. Components of less than 0.4 % of the image are left out.
class Ade20kDecoder : public NetworkDecoder {
  DEFINE_MRPT_OBJECT(Ade20kDecoder, roomgraph)
 public:
  std::string name() const override { return "ade20k"; }
  Preprocessing preprocessing() const override;
  bool recognises(const NetworkOutputs& outputs, int classes) const override;
  std::vector<RawBox> decode(const NetworkOutputs& outputs, const DecodingTask& task) const override;
  bool segments() const override { return true; }
};

}  // namespace roomgraph
