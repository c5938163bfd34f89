// SPDX-License-Identifier: BSD-3-Clause
// Faults of pictures and depth images.
#pragma once

#include <mrpt/obs/CObservation3DRangeScan.h>

#include <cstdint>

#include "fault.h"

namespace roomgraph {

/// Pictures of one grey level (0: covered or unlit, 255: blinded); depth stays. Detections that were recorded
/// with them are empty: nobody finds anything in such a picture.
class UniformPictureFault : public Fault {
 public:
  UniformPictureFault(std::uint8_t level, FaultWindow window) : level_(level), window_(window) {}
  PassingRecords pass(PassingRecord record) override;

 private:
  std::uint8_t level_;
  FaultWindow window_;
};

/// Depth images without a valid pixel; colour stays.
class NoDepthFault : public Fault {
 public:
  explicit NoDepthFault(FaultWindow window) : window_(window) {}
  PassingRecords pass(PassingRecord record) override;

 private:
  FaultWindow window_;
};

}  // namespace roomgraph
