// SPDX-License-Identifier: BSD-3-Clause
// Spans of pieces, and measures that are remembered.
#include <gmock/gmock.h>

#include "roomgraph/batch/plan.h"
#include "roomgraph/core/errors.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

using ::testing::SizeIs;

TEST(Pieces, CoverTheRecordingAndOverlap) {
  for (const double seconds : {1400.0, 1800.0, 3600.0, 3599.5, 86400.0}) {
    const auto pieces = piecesOf(seconds, {600, 20});
    ASSERT_GE(pieces.size(), 2u);
    EXPECT_EQ(pieces.front().from_s, 0);
    EXPECT_EQ(pieces.back().until_s, 0) << "to the end";
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const double end = i + 1 < pieces.size() ? pieces[i].until_s : seconds;
      EXPECT_LE(end - pieces[i].from_s, 600 * 1.25 + 20);
      EXPECT_GE(end - pieces[i].from_s, 600 * 0.6);
      const double common = i > 0 ? pieces[i - 1].until_s - pieces[i].from_s : 20;
      EXPECT_NEAR(common, 20, 1e-9);
    }
  }
  EXPECT_THAT(piecesOf(3600, {600, 20}), SizeIs(6));
}

TEST(Pieces, WhatIsHardlyLongerStaysWhole) {
  EXPECT_THAT(piecesOf(600, {600, 20}), SizeIs(0));
  EXPECT_THAT(piecesOf(740, {600, 20}), SizeIs(0));
  EXPECT_THAT(piecesOf(760, {600, 20}), SizeIs(2));
  EXPECT_THAT(piecesOf(0, {600, 20}), SizeIs(0));
  EXPECT_THAT(piecesOf(1e6, {0, 20}), SizeIs(0));
}

TEST(Pieces, AMeasureIsThatOfTheFileAsItIs) {
  const TemporaryFolder folder;
  const auto rawlog = folder.write("a.rawlog", "twelve bytes");
  const auto file = folder.file("a.measure");
  EXPECT_FALSE(readMeasure(file, rawlog).has_value());
  writeMeasure(file, rawlog, {3600.25, "abc"});
  EXPECT_NEAR(readMeasure(file, rawlog)->seconds, 3600.25, 1e-5);
  EXPECT_EQ(readMeasure(file, rawlog)->sha256, "abc");
  folder.write("a.rawlog", "other bytes, and more of them");
  EXPECT_FALSE(readMeasure(file, rawlog).has_value());
}

TEST(Pieces, TooMuchInCommonIsRefused) {
  EXPECT_NO_THROW(requireSensibleSplit({0, 20}));
  EXPECT_NO_THROW(requireSensibleSplit({60, 20}));
  EXPECT_THROW(requireSensibleSplit({59, 20}), ConfigError);
}

}  // namespace
}  // namespace roomgraph::test
