// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include <gmock/gmock.h>

#include "rawlog_maker.h"
#include "roomgraph/datasets/rawlog_reader.h"

namespace roomgraph {
namespace {

using namespace roomgraph::test;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

struct Result {
  int records = 0;
  ReadStatistics statistics;
};

Result read(const std::filesystem::path& file, const ReadOptions& options = {}) {
  RawlogReader reader(file, options);
  Result result;
  while (reader.next()) ++result.records;
  result.statistics = reader.statistics();
  EXPECT_FALSE(reader.next()) << "stays at its end";
  return result;
}

TEST(RawlogDamage, CutAtEveryByteAllCompleteRecordsAreUsed) {
  TemporaryFolder folder;
  const std::vector<Object> objects = {makeScan(1), makeOdometry(2, 1, 1, 0), makeImages(3), makeScan(4)};
  std::string bytes;
  std::vector<std::size_t> ends;
  for (const auto& object : objects) ends.push_back((bytes += bytesOf(object)).size());
  const auto file = folder / "x.rawlog";
  for (std::size_t size = 60; size <= bytes.size(); ++size) {
    writeBytes(file, bytes.substr(0, size));
    const auto complete =
        std::count_if(ends.begin(), ends.end(), [&](std::size_t end) { return end <= size; });
    const bool between = std::find(ends.begin(), ends.end(), size) != ends.end();
    const auto result = read(file);
    ASSERT_EQ(result.records, complete) << "cut at byte " << size;
    ASSERT_EQ(result.statistics.warning.empty(), between) << "cut at byte " << size;
    if (between) continue;
    const std::size_t begin = complete == 0 ? 0 : ends[static_cast<std::size_t>(complete) - 1];
    ASSERT_THAT(result.statistics.warning, HasSubstr("byte " + std::to_string(begin) + " "))
        << "cut at " << size;
  }
}

TEST(RawlogDamage, CutGzipGivesTheRecordsBeforeTheCut) {
  TemporaryFolder folder;
  std::vector<Object> objects;
  for (int i = 0; i < 50; ++i) objects.push_back(makeScan(i, 1.f + 0.01f * static_cast<float>(i * i), 40));
  writeRawlog(folder / "whole.rawlog", objects);
  const std::string bytes = readBytes(folder / "whole.rawlog");
  int before = 0;
  for (std::size_t share = 2; share <= 10; ++share) {
    writeBytes(folder / "cut.rawlog", bytes.substr(0, (bytes.size() - 1) * share / 10));
    const auto result = read(folder / "cut.rawlog");
    EXPECT_GE(result.records, before);
    EXPECT_THAT(result.statistics.warning, HasSubstr("gzip")) << "share " << share;
    EXPECT_THAT(result.statistics.warning, HasSubstr("byte"));
    before = result.records;
  }
  // Only the end of the gzip trailer is missing: every record is there, and the damage is still reported.
  EXPECT_EQ(before, 50);
}

TEST(RawlogDamage, UnknownClassInTheMiddleIsSteppedOver) {
  TemporaryFolder folder;
  std::string strange = bytesOf(makeScan(2));
  // Same length, so that the header stays well formed.
  const auto at = strange.find("CObservation2DRangeScan");
  ASSERT_NE(at, std::string::npos);
  strange.replace(at, 23, "CObservationFromTheMoon");
  writeBytes(folder / "x.rawlog", bytesOf(makeScan(1)) + strange + bytesOf(makeScan(3)));
  const auto result = read(folder / "x.rawlog");
  EXPECT_EQ(result.records, 2);
  ASSERT_EQ(result.statistics.skipped.size(), 1u);
  EXPECT_THAT(result.statistics.skipped.begin()->first, HasSubstr("CObservationFromTheMoon"));
  EXPECT_THAT(result.statistics.warning, IsEmpty());
}

TEST(RawlogDamage, BrokenBytesCostOnlyTheirRecord) {
  TemporaryFolder folder;
  for (const auto& victim : {Object(makeScan(2)), Object(makeImages(2)), Object(makeOdometry(2, 0, 0, 0))}) {
    std::string broken = bytesOf(victim);
    broken.erase(broken.size() / 2, 3);  // what follows is shifted: the end flag is not where it should be
    writeBytes(folder / "x.rawlog",
               bytesOf(makeScan(1)) + broken + bytesOf(makeOdometry(3, 0, 0, 0)) + bytesOf(makeScan(4)));
    const auto result = read(folder / "x.rawlog");
    EXPECT_GE(result.records, 2) << victim->GetRuntimeClass()->className;
    EXPECT_THAT(result.statistics.skipped, Not(IsEmpty())) << victim->GetRuntimeClass()->className;
    EXPECT_THAT(result.statistics.warning, IsEmpty());
  }
}

TEST(RawlogDamage, BrokenSensoryFrameIsLeftOutAsAWhole) {
  TemporaryFolder folder;
  std::string broken = bytesOf(makeSensoryFrame({makeScan(2), makeScan(2.1)}));
  broken.erase(100, 5);
  writeBytes(folder / "x.rawlog", bytesOf(makeAction(1, 1, 0, 0)) + bytesOf(makeSensoryFrame({makeScan(1)})) +
                                      bytesOf(makeAction(2, 1, 0, 0)) + broken +
                                      bytesOf(makeAction(3, 1, 0, 0)) +
                                      bytesOf(makeSensoryFrame({makeScan(3)})));
  const auto result = read(folder / "x.rawlog");
  EXPECT_EQ(result.records, 5);
  EXPECT_EQ(result.statistics.used.at("CActionCollection"), 3);
}

TEST(RawlogDamage, SkippedImagesAtTheEndAreCheckedForCompleteness) {
  TemporaryFolder folder;
  const std::string bytes = bytesOf(makeScan(1)) + bytesOf(makeImages(2));
  const ReadOptions scans_only{.frames = false};
  writeBytes(folder / "x.rawlog", bytes);
  EXPECT_THAT(read(folder / "x.rawlog", scans_only).statistics.warning, IsEmpty());
  writeBytes(folder / "x.rawlog", bytes.substr(0, bytes.size() - 40));
  const auto result = read(folder / "x.rawlog", scans_only);
  EXPECT_EQ(result.records, 1);
  EXPECT_THAT(result.statistics.warning, HasSubstr("byte"));
}

}  // namespace
}  // namespace roomgraph
