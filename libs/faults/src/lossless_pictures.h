// SPDX-License-Identifier: BSD-3-Clause
// MRPT's switch between JPEG and uncompressed pictures in rawlogs.
#pragma once

#include <mrpt/img/CImage.h>

namespace roomgraph {

/// Pictures are written without loss as long as it lives.
class LosslessPictures {
 public:
  LosslessPictures() { mrpt::img::CImage::DISABLE_JPEG_COMPRESSION(true); }
  ~LosslessPictures() { mrpt::img::CImage::DISABLE_JPEG_COMPRESSION(before_); }
  LosslessPictures(const LosslessPictures&) = delete;
  LosslessPictures& operator=(const LosslessPictures&) = delete;

 private:
  const bool before_ = mrpt::img::CImage::DISABLE_JPEG_COMPRESSION();
};

}  // namespace roomgraph
