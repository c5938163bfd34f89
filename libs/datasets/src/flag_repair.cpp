// SPDX-License-Identifier: BSD-3-Clause
// Flags read through their bytes, as a bool out of a damaged file may be neither true nor false.
#include "flag_repair.h"

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <cstring>

namespace roomgraph {
namespace {

void repair(bool& flag) {
  unsigned char byte = 0;
  std::memcpy(&byte, &flag, 1);
  flag = byte != 0;
}

}  // namespace

void repairFlags(mrpt::serialization::CSerializable& record) {
  if (auto* images = dynamic_cast<mrpt::obs::CObservation3DRangeScan*>(&record)) {
    for (bool* flag : {&images->hasPoints3D, &images->hasRangeImage, &images->range_is_depth,
                       &images->hasIntensityImage, &images->hasConfidenceImage})
      repair(*flag);
  } else if (auto* scan = dynamic_cast<mrpt::obs::CObservation2DRangeScan*>(&record)) {
    repair(scan->rightToLeft);
  } else if (auto* frame = dynamic_cast<mrpt::obs::CSensoryFrame*>(&record)) {
    for (const auto& observation : *frame)
      if (observation) repairFlags(*observation);
  }
}

bool rangeImageIsInAFile(const mrpt::obs::CObservation3DRangeScan& images) {
  return !images.rangeImage_getExternalStorageFile("").empty();
}

}  // namespace roomgraph
