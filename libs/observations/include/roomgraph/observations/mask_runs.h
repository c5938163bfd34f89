// SPDX-License-Identifier: BSD-3-Clause
// Run-length encoding of binary masks.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace roomgraph {

/// A binary mask as lengths of alternating runs, row by row, the first of them off (it may be 0). Empty when
/// there is no mask.
struct MaskRuns {
  std::uint32_t width = 0, height = 0;  ///< px
  std::vector<std::uint32_t> runs;      ///< sum: width * height
};

/// CV_8UC1, on where not 0. An empty picture gives empty runs.
MaskRuns toRuns(const cv::Mat& mask);
/// CV_8UC1 (0 / 255); empty when the runs are, or do not fill a picture of sane size (a damaged record).
cv::Mat toMask(const MaskRuns& runs);

}  // namespace roomgraph
