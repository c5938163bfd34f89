// SPDX-License-Identifier: BSD-3-Clause
// Spans of pieces, and measures that are remembered.
#include <gmock/gmock.h>

#include <algorithm>

#include "roomgraph/batch/plan.h"
#include "roomgraph/core/errors.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

using ::testing::SizeIs;

RecordingMeasure ofLength(double seconds) { return {seconds, "", 0.1}; }

TEST(Pieces, CoverTheRecordingAndOverlap) {
  for (const double seconds : {1400.0, 1800.0, 3600.0, 3599.5, 86400.0}) {
    const auto pieces = piecesOf(ofLength(seconds), {600, 20});
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
  EXPECT_THAT(piecesOf(ofLength(3600), {600, 20}), SizeIs(6));
}

TEST(Pieces, WhatIsHardlyLongerStaysWhole) {
  EXPECT_THAT(piecesOf(ofLength(600), {600, 20}), SizeIs(0));
  EXPECT_THAT(piecesOf(ofLength(740), {600, 20}), SizeIs(0));
  EXPECT_THAT(piecesOf(ofLength(760), {600, 20}), SizeIs(2));
  EXPECT_THAT(piecesOf(ofLength(0), {600, 20}), SizeIs(0));
  EXPECT_THAT(piecesOf(ofLength(1e6), {0, 20}), SizeIs(0));
}

TEST(Pieces, AMeasureIsThatOfTheFileAsItIs) {
  const TemporaryFolder folder;
  const auto rawlog = folder.write("a.rawlog", "twelve bytes");
  const auto file = folder.file("a.measure");
  EXPECT_FALSE(readMeasure(file, rawlog).has_value());
  writeMeasure(file, rawlog, {3600.25, "abc", 7.5});
  EXPECT_NEAR(readMeasure(file, rawlog)->seconds, 3600.25, 1e-5);
  EXPECT_EQ(readMeasure(file, rawlog)->sha256, "abc");
  EXPECT_EQ(readMeasure(file, rawlog)->longest_gap_s, 7.5);
  folder.write("a.rawlog", "other bytes, and more of them");
  EXPECT_FALSE(readMeasure(file, rawlog).has_value());
}

TEST(Pieces, NoneIsEmpty) {
  std::vector<double> stamps;
  for (int i = 0; i < 18000; ++i) stamps.push_back(1e9 + 0.1 * i);
  std::reverse(stamps.begin() + 5000, stamps.begin() + 6000);
  EXPECT_NEAR(measureOf(stamps).seconds, 1799.9, 1e-6);
  EXPECT_NEAR(measureOf(stamps).longest_gap_s, 0.1, 1e-6);
  EXPECT_THAT(piecesOf(measureOf(stamps), {600, 20}), SizeIs(3));
  for (const double stray : {0.0, 1e9 + 1e7}) {  // one record of another time
    stamps.push_back(stray);
    EXPECT_GE(measureOf(stamps).longest_gap_s, 9e6);
    EXPECT_TRUE(hasEmptyPieces(measureOf(stamps), {600, 20}));
    EXPECT_THAT(piecesOf(measureOf(stamps), {600, 20}), SizeIs(0));
    stamps.pop_back();
  }
  EXPECT_FALSE(hasEmptyPieces({1e6, "", 299}, {600, 20}));
  EXPECT_EQ(measureOf({}).seconds, 0);
}

TEST(Pieces, TooMuchInCommonIsRefused) {
  EXPECT_NO_THROW(requireSensibleSplit({0, 20}));
  EXPECT_NO_THROW(requireSensibleSplit({60, 20}));
  EXPECT_THROW(requireSensibleSplit({59, 20}), ConfigError);
}

}  // namespace
}  // namespace roomgraph::test
