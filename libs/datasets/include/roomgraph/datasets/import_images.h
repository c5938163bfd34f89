// SPDX-License-Identifier: BSD-3-Clause
// Images in the records of an import: depth of any encoding, colour inside the rawlog or beside it.
#pragma once

#include <mrpt/obs/CObservation3DRangeScan.h>

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "roomgraph/datasets/import_output.h"

namespace roomgraph {

/// Unit in which depth is kept, m: of 16UC1 a millimetre (REP 118), of 32FC1 0.2 mm (up to 13.1 m).
double depthUnit(const cv::Mat& depth);
/// Sets range image and unit. Values that are not finite, negative or beyond 16 bit become 0: no measurement.
void setDepth(mrpt::obs::CObservation3DRangeScan& record, const cv::Mat& depth);

/// Puts colour and depth of a record into files in output.images() and lets it refer to them. Colour is
/// without further loss: `picture` when it is a JPEG, else PNG. Throws RunError.
void storeOutside(mrpt::obs::CObservation3DRangeScan& record, const std::vector<std::uint8_t>& picture,
                  const ImportOutput& output);

/// MRPT's setting for all images inside rawlogs, put back at the end: without loss, or JPEG of this quality.
class EmbeddedImages {
 public:
  explicit EmbeddedImages(std::optional<int> jpeg_quality);
  ~EmbeddedImages();
  EmbeddedImages(const EmbeddedImages&) = delete;
  EmbeddedImages& operator=(const EmbeddedImages&) = delete;

 private:
  const bool disabled_;
  const int quality_;
};

}  // namespace roomgraph
