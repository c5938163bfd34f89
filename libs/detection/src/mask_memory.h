// SPDX-License-Identifier: BSD-3-Clause
// Bounded memory for the masks of one image.
#pragma once

#include <cstdint>

#include "roomgraph/observations/mask_runs.h"

namespace roomgraph {

/// Makes the masks of one image. Few numbers may stand for a mask of any size: together they have at most 2^26 pixels.
class MaskMemory {
 public:
  /// As roomgraph::toMask(); also empty when the masks before have left too little.
  cv::Mat toMask(const MaskRuns& runs) {
    if (std::uint64_t{runs.width} * runs.height > left_) return {};
    cv::Mat mask = roomgraph::toMask(runs);
    left_ -= mask.total();
    return mask;
  }

 private:
  std::uint64_t left_ = 1u << 26;
};

}  // namespace roomgraph
