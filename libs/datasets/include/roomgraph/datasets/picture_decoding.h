// SPDX-License-Identifier: BSD-3-Clause
// Compressed pictures as OpenCV matrices.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>

#include "roomgraph/core/outcome.h"

namespace roomgraph {

/// JPEG or PNG, by OpenCV with its reading flags. Memory is bounded, whatever the picture's header asks for.
/// Fails when it is empty, damaged or neither.
Outcome<cv::Mat> decodePicture(std::span<const std::uint8_t> bytes, int flags);

/// Depth in RVL behind its size (columns and rows of 32 bits, little endian): CV_16UC1. Fails when it is
/// damaged.
Outcome<cv::Mat> decodeRvl(std::span<const std::uint8_t> bytes);

}  // namespace roomgraph
