// SPDX-License-Identifier: BSD-3-Clause
// Pictures in files, with memory bounded by the size of the file.
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>

#include "roomgraph/core/allocation_limit.h"

namespace roomgraph {

/// From now on a thread with an AllocationLimit cannot make an OpenCV image of more than 256 MB: pictures are
/// compressed, so that a damaged size in a JPEG's header could ask for gigabytes whatever the record's
/// length.
void countImageMemory();

/// During its lifetime this thread cannot make a larger OpenCV image than a file of these bytes may hold: 64 MB and 2048
/// bytes for each byte (twice what PNG's compression reaches), at most 256 MB or four times the file. Decoders get as
/// much again; what is more throws std::bad_alloc.
class ImageMemoryLimit {
 public:
  explicit ImageMemoryLimit(std::uintmax_t file_bytes);
  ~ImageMemoryLimit();
  ImageMemoryLimit(const ImageMemoryLimit&) = delete;
  ImageMemoryLimit& operator=(const ImageMemoryLimit&) = delete;

 private:
  double outer_;
  AllocationLimit decoders_;
};

/// The picture in a file as cv::imread() gives it with these flags, within ImageMemoryLimit. Empty when there is no such
/// file, or when it cannot be read.
cv::Mat readImageFile(const std::filesystem::path& file, int flags);

}  // namespace roomgraph
