// SPDX-License-Identifier: BSD-3-Clause
// OpenCV allocator with a size limit.
#include "roomgraph/observations/image_file.h"

#include <algorithm>
#include <new>
#include <opencv2/imgcodecs.hpp>

namespace roomgraph {
namespace {

constexpr double kLargestImageBytes = 256.0 * (1 << 20);

thread_local double largest_image_bytes = kLargestImageBytes;

// OpenCV's own allocator behind a check.
class CheckedAllocator : public cv::MatAllocator {
 public:
  cv::UMatData* allocate(int dimensions, const int* sizes, int type, void* data, std::size_t* step,
                         cv::AccessFlag flags, cv::UMatUsageFlags usage) const override {
    double bytes = static_cast<double>(CV_ELEM_SIZE(type));
    for (int i = 0; i < dimensions; ++i) bytes *= sizes[i];
    if (AllocationLimit::active() && !data && bytes > largest_image_bytes) throw std::bad_alloc();
    return standard_->allocate(dimensions, sizes, type, data, step, flags, usage);
  }
  bool allocate(cv::UMatData* data, cv::AccessFlag flags, cv::UMatUsageFlags usage) const override {
    return standard_->allocate(data, flags, usage);
  }
  void deallocate(cv::UMatData* data) const override { standard_->deallocate(data); }

 private:
  cv::MatAllocator* standard_ = cv::Mat::getStdAllocator();
};

double largestImageOf(std::uintmax_t file_bytes) {
  constexpr double kSpareBytes = 64.0 * (1 << 20), kBytesPerByte = 2048, kUncompressed = 4;
  const auto bytes = static_cast<double>(file_bytes);
  return std::min(kSpareBytes + kBytesPerByte * bytes, std::max(kLargestImageBytes, kUncompressed * bytes));
}

}  // namespace

void countImageMemory() {
  // Never destroyed: images may outlive everything else.
  static auto* const allocator = new CheckedAllocator;
  cv::Mat::setDefaultAllocator(allocator);
}

ImageMemoryLimit::ImageMemoryLimit(std::uintmax_t file_bytes)
    : outer_(largest_image_bytes), decoders_(static_cast<std::size_t>(2 * largestImageOf(file_bytes))) {
  countImageMemory();
  largest_image_bytes = largestImageOf(file_bytes);
}

ImageMemoryLimit::~ImageMemoryLimit() {
  largest_image_bytes = outer_;
}

cv::Mat readImageFile(const std::filesystem::path& file, int flags) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return {};
  const auto bytes = std::filesystem::file_size(file, error);
  try {
    const ImageMemoryLimit limit(error ? 0 : bytes);
    return cv::imread(file.string(), flags);
  } catch (const std::exception&) {
    return {};
  }
}

}  // namespace roomgraph
