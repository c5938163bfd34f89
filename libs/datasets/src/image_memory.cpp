// SPDX-License-Identifier: BSD-3-Clause
// Loading of images under an AllocationLimit.
#include "image_memory.h"

#include <new>
#include <stdexcept>

#include "roomgraph/core/allocation_limit.h"

namespace roomgraph {

void loadImages(mrpt::obs::CObservation3DRangeScan& observation) {
  constexpr std::size_t kExternalBytes = 256u << 20;
  try {
    const AllocationLimit limit(kExternalBytes);
    observation.load();
  } catch (const std::bad_alloc&) {
    throw std::runtime_error("it would take more than 256 MB");
  }
}

}  // namespace roomgraph
