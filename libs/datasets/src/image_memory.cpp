// SPDX-License-Identifier: BSD-3-Clause
// OpenCV allocator with a size limit, and loading of images under an AllocationLimit.
#include "image_memory.h"

#include <new>
#include <opencv2/core/mat.hpp>
#include <stdexcept>

#include "roomgraph/core/allocation_limit.h"

namespace roomgraph {
namespace {

constexpr double kLargestImageBytes = 256.0 * (1 << 20);
constexpr std::size_t kExternalBytes = 256u << 20;

// OpenCV's own allocator behind a check.
class CheckedAllocator : public cv::MatAllocator {
 public:
  cv::UMatData* allocate(int dimensions, const int* sizes, int type, void* data, std::size_t* step,
                         cv::AccessFlag flags, cv::UMatUsageFlags usage) const override {
    double bytes = static_cast<double>(CV_ELEM_SIZE(type));
    for (int i = 0; i < dimensions; ++i) bytes *= sizes[i];
    if (AllocationLimit::active() && !data && bytes > kLargestImageBytes) throw std::bad_alloc();
    return standard_->allocate(dimensions, sizes, type, data, step, flags, usage);
  }
  bool allocate(cv::UMatData* data, cv::AccessFlag flags, cv::UMatUsageFlags usage) const override {
    return standard_->allocate(data, flags, usage);
  }
  void deallocate(cv::UMatData* data) const override { standard_->deallocate(data); }

 private:
  cv::MatAllocator* standard_ = cv::Mat::getStdAllocator();
};

}  // namespace

void countImageMemory() {
  // Never destroyed: images may outlive everything else.
  static auto* const allocator = new CheckedAllocator;
  cv::Mat::setDefaultAllocator(allocator);
}

void loadImages(mrpt::obs::CObservation3DRangeScan& observation) {
  try {
    const AllocationLimit limit(kExternalBytes);
    observation.load();
  } catch (const std::bad_alloc&) {
    throw std::runtime_error("it would take more than 256 MB");
  }
}

}  // namespace roomgraph
