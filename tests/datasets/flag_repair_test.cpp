// SPDX-License-Identifier: BSD-3-Clause
// Flags out of damaged records, byte by byte.
#include "flag_repair.h"

#include <gtest/gtest.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <cstring>

#include "rawlog_maker.h"

namespace roomgraph::test {
namespace {

void damage(bool& flag, unsigned char byte) {
  std::memcpy(&flag, &byte, 1);
}
int byteOf(const bool& flag) {
  unsigned char byte = 0;
  std::memcpy(&byte, &flag, 1);
  return byte;
}

TEST(FlagRepair, WhatIsNotZeroIsTrue) {
  const auto images = makeImages(1);
  const auto scan = makeScan(1);
  bool* const flags[] = {&images->hasPoints3D,       &images->hasRangeImage,      &images->range_is_depth,
                         &images->hasIntensityImage, &images->hasConfidenceImage, &scan->rightToLeft};
  for (bool* flag : flags) damage(*flag, 0x7f);
  mrpt::obs::CSensoryFrame frame;
  frame.insert(images);
  frame.insert(scan);
  repairFlags(frame);
  for (const bool* flag : flags) EXPECT_EQ(byteOf(*flag), 1);
}

TEST(FlagRepair, SoundFlagsStay) {
  const auto images = makeImages(1);
  images->hasPoints3D = false;
  images->hasRangeImage = true;
  repairFlags(*images);
  EXPECT_EQ(byteOf(images->hasPoints3D), 0);
  EXPECT_EQ(byteOf(images->hasRangeImage), 1);
}

}  // namespace
}  // namespace roomgraph::test
