// SPDX-License-Identifier: BSD-3-Clause
// RawlogReader on damaged files: every cut, wrong sizes, broken records and JPEG images.
#include <gmock/gmock.h>

#include <cstring>

#include "memory_limit.h"
#include "rawlog_maker.h"
#include "roomgraph/datasets/rawlog_reader.h"

namespace roomgraph {
namespace {

using namespace roomgraph::test;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

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
  const auto file = folder.file("x.rawlog");
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
  writeRawlog(folder.file("whole.rawlog"), objects);
  const std::string bytes = readBytes(folder.file("whole.rawlog"));
  int before = 0;
  for (std::size_t share = 2; share <= 10; ++share) {
    writeBytes(folder.file("cut.rawlog"), bytes.substr(0, (bytes.size() - 1) * share / 10));
    const auto result = read(folder.file("cut.rawlog"));
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
  writeBytes(folder.file("x.rawlog"), bytesOf(makeScan(1)) + strange + bytesOf(makeScan(3)));
  const auto result = read(folder.file("x.rawlog"));
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
    writeBytes(folder.file("x.rawlog"),
               bytesOf(makeScan(1)) + broken + bytesOf(makeOdometry(3, 0, 0, 0)) + bytesOf(makeScan(4)));
    const auto result = read(folder.file("x.rawlog"));
    EXPECT_GE(result.records, 2) << victim->GetRuntimeClass()->className;
    EXPECT_THAT(result.statistics.skipped, Not(IsEmpty())) << victim->GetRuntimeClass()->className;
    EXPECT_THAT(result.statistics.warning, IsEmpty());
  }
}

TEST(RawlogDamage, BrokenSensoryFrameIsLeftOutAsAWhole) {
  TemporaryFolder folder;
  std::string broken = bytesOf(makeSensoryFrame({makeScan(2), makeScan(2.1)}));
  broken.erase(100, 5);
  writeBytes(folder.file("x.rawlog"),
             bytesOf(makeAction(1, 1, 0, 0)) + bytesOf(makeSensoryFrame({makeScan(1)})) +
                 bytesOf(makeAction(2, 1, 0, 0)) + broken + bytesOf(makeAction(3, 1, 0, 0)) +
                 bytesOf(makeSensoryFrame({makeScan(3)})));
  const auto result = read(folder.file("x.rawlog"));
  EXPECT_EQ(result.records, 5);
  EXPECT_EQ(result.statistics.used.at("CActionCollection"), 3);
}

// A count of elements, or the size of a picture, that the record cannot hold.
void overwrite(std::string& bytes, std::size_t at, std::uint32_t value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

TEST(RawlogDamage, ImpossibleSizesCostOnlyTheirRecordAndNoMemory) {
  if (!test::kMemoryCanBeLimited) GTEST_SKIP() << "not under this sanitizer";
  TemporaryFolder folder;
  for (const auto& victim :
       {Object(makeScan(2, 2, 300)), Object(makeImages(2)), Object(makeOdometry(2, 0, 0, 0))}) {
    const std::string good = bytesOf(victim);
    for (std::size_t at = 30; at + 5 < std::min<std::size_t>(good.size(), 700); ++at)
      for (const std::uint32_t size : {0xffffffffu, 0x80000000u, 0x40000000u}) {
        std::string broken = good;
        overwrite(broken, at, size);
        writeBytes(folder.file("x.rawlog"), bytesOf(makeScan(1)) + broken + bytesOf(makeScan(3)));
        const auto result = read(folder.file("x.rawlog"));
        ASSERT_GE(result.records, 2) << victim->GetRuntimeClass()->className << " byte " << at;
      }
  }
  EXPECT_LT(test::peakMegabytes(), 700);
}

TEST(RawlogDamage, SizeOfAScanThatDoesNotFitItsBytesIsNamed) {
  TemporaryFolder folder;
  std::string broken = bytesOf(makeScan(2, 2, 300));
  std::size_t at = 0;
  const std::uint32_t count = 300;
  at = broken.find(std::string(reinterpret_cast<const char*>(&count), sizeof count));
  ASSERT_NE(at, std::string::npos);
  overwrite(broken, at, 0x7fffffff);
  writeBytes(folder.file("x.rawlog"), bytesOf(makeScan(1)) + broken + bytesOf(makeScan(3)));
  const auto result = read(folder.file("x.rawlog"));
  EXPECT_EQ(result.records, 2);
  ASSERT_EQ(result.statistics.skipped.size(), 1u);
  EXPECT_THAT(result.statistics.skipped.begin()->first,
              HasSubstr("CObservation2DRangeScan: a size in it does not fit its length"));
}

std::string jpegRecord() {
  const bool plain = mrpt::img::CImage::DISABLE_JPEG_COMPRESSION();
  mrpt::img::CImage::DISABLE_JPEG_COMPRESSION(false);
  const std::string bytes = bytesOf(makeImages(2));
  mrpt::img::CImage::DISABLE_JPEG_COMPRESSION(plain);
  return bytes;
}

TEST(RawlogDamage, SizeInTheHeaderOfAJpegFillsNoMemory) {
  TemporaryFolder folder;
  std::string broken = jpegRecord();
  // Start of frame: marker, length, 8 bits, height, width.
  const auto at = broken.find("\xff\xc0");
  ASSERT_NE(at, std::string::npos);
  for (std::size_t i = 5; i < 9; ++i) broken[at + i] = static_cast<char>(i % 2 ? 0x7f : 0xff);
  writeBytes(folder.file("x.rawlog"), bytesOf(makeScan(1)) + broken + bytesOf(makeScan(3)));
  const auto result = read(folder.file("x.rawlog"));
  EXPECT_EQ(result.records, 2);
  EXPECT_THAT(result.statistics.skipped.begin()->first, HasSubstr("does not fit its length"));
  EXPECT_LT(test::peakMegabytes(), 700);
}

// libjpeg's own handler of errors would call exit().
TEST(RawlogDamage, JpegWithoutItsDataCostsOnlyItsRecord) {
  TemporaryFolder folder;
  std::string broken = jpegRecord();
  const auto scan = broken.find("\xff\xda");
  ASSERT_NE(scan, std::string::npos);
  broken[scan + 1] = '\xd9';  // the end of the image instead of the start of its data
  writeBytes(folder.file("x.rawlog"), bytesOf(makeScan(1)) + broken + bytesOf(makeScan(3)));
  ::testing::internal::CaptureStderr();
  const auto result = read(folder.file("x.rawlog"));
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(result.records, 2);
  ASSERT_EQ(result.statistics.skipped.size(), 1u);
  EXPECT_THAT(result.statistics.skipped.begin()->first, HasSubstr("broken record: CObservation3DRangeScan"));
}

TEST(RawlogDamage, LongRecordsAmongOthersOfAPairAreParsedWhole) {
  TemporaryFolder folder;
  // Mixed formats: the observations in a sensory frame are not taken for the next record.
  std::vector<mrpt::obs::CObservation::Ptr> many;
  for (int i = 0; i < 50; ++i) many.push_back(makeScan(2 + 0.01 * i, 2, 5000));
  writeRawlog(folder.file("x.rawlog"), {makeScan(1), makeSensoryFrame(many), makeScan(3)});
  const auto result = read(folder.file("x.rawlog"));
  EXPECT_EQ(result.records, 52);
  EXPECT_THAT(result.statistics.skipped, IsEmpty());
}

// Buffers of the reader itself, which grow with the file, do not count as memory of a record.
TEST(RawlogDamage, LongRecordingsOfSmallAndLargeRecordsAreReadWhole) {
  TemporaryFolder folder;
  std::vector<Object> objects;
  for (int i = 0; i < 300; ++i) objects.push_back(makeScan(0.1 * i, 2 + 1e-3f * static_cast<float>(i), i % 3 == 0 ? 20000 : 100));
  objects.push_back(makeImages(31, 1280, 720));
  for (int i = 320; i < 600; ++i) objects.push_back(makeScan(0.1 * i, 2 + 1e-3f * static_cast<float>(i), i % 3 == 0 ? 20000 : 100));
  writeRawlog(folder.file("x.rawlog"), objects);
  const auto result = read(folder.file("x.rawlog"));
  EXPECT_EQ(result.records, 581);
  EXPECT_THAT(result.statistics.skipped, IsEmpty());
}

TEST(RawlogDamage, SkippedImagesAtTheEndAreCheckedForCompleteness) {
  TemporaryFolder folder;
  const std::string bytes = bytesOf(makeScan(1)) + bytesOf(makeImages(2));
  const ReadOptions scans_only{.frames = false};
  writeBytes(folder.file("x.rawlog"), bytes);
  EXPECT_THAT(read(folder.file("x.rawlog"), scans_only).statistics.warning, IsEmpty());
  writeBytes(folder.file("x.rawlog"), bytes.substr(0, bytes.size() - 40));
  const auto result = read(folder.file("x.rawlog"), scans_only);
  EXPECT_EQ(result.records, 1);
  EXPECT_THAT(result.statistics.warning, HasSubstr("byte"));
}

}  // namespace
}  // namespace roomgraph
