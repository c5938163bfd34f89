// SPDX-License-Identifier: BSD-3-Clause
// Files that end too early: every length of the records of the shipped rawlogs and of the shipped map.
#include <gmock/gmock.h>

#include <cstdlib>

#include "errors_of.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/datasets/stored_observations.h"
#include "roomgraph/observations/map_file.h"
#include "three_frames.h"

// In images, one length of 61 is tried, or every one when the environment variable ROOMGRAPH_EVERY_TRUNCATION is set
// (some minutes).

namespace roomgraph::test {
namespace {

using Path = std::filesystem::path;

const Path kRawlogs = Path(ROOMGRAPH_SOURCE_DIR) / "rawlogs";
constexpr std::size_t kEndsOfImages = 600, kLongRecord = 8192;

struct WhatWasRead {
  int records = 0;
  std::string warning;
};

WhatWasRead readAll(const Path& file) {
  RawlogReader reader(file);
  WhatWasRead out;
  while (reader.next()) ++out.records;
  out.warning = reader.statistics().warning;
  return out;
}

/// Serialised records of a rawlog, in its order.
std::vector<std::string> recordsOf(const Path& file) {
  std::vector<std::string> out;
  StoredObservationReader reader(file);
  while (const auto stored = reader.next()) out.push_back(stored->bytes);
  return out;
}

std::size_t stepAt(std::size_t length, std::size_t size) {
  const bool inside = length > kEndsOfImages && length + kEndsOfImages < size;
  if (size < kLongRecord || !inside || std::getenv("ROOMGRAPH_EVERY_TRUNCATION")) return 1;
  constexpr std::size_t kStep = 61;
  return kStep;
}

/// A sound record and then a record at each of its lengths: the first is used, the second when it is whole, and told
/// when it is not.
void expectEveryLength(const TemporaryFolder& folder, const std::string& before, const std::string& record) {
  const auto file = folder.write("cut.rawlog", before + record);
  for (std::size_t length = record.size() - 1; length > 0;
       length -= std::min(length, stepAt(length, record.size()))) {
    std::filesystem::resize_file(file, before.size() + length);
    const auto read = readAll(file);
    ASSERT_EQ(read.records, 1) << length << " of " << record.size() << " bytes";
    ASSERT_THAT(read.warning, ::testing::HasSubstr("begins at byte " + std::to_string(before.size()) + " "))
        << length << " of " << record.size() << " bytes";
  }
}

void expectCutRecordsAreTold(const std::string& name) {
  const TemporaryFolder folder;
  const std::string before = bytesOf(makeOdometry(1, 0, 0, 0));
  const auto records = recordsOf(kRawlogs / name);
  ASSERT_GT(records.size(), 10u);
  std::map<std::size_t, int> images;  // of a size; the first of them stands for all
  for (const auto& record : records) {
    ASSERT_FALSE(record.empty());
    if (record.size() >= kLongRecord && images[record.size() >> 16]++ > 0) continue;
    expectEveryLength(folder, before, record);
  }
}

TEST(Truncation, EveryLengthOfTheRecordsOfARobot) { expectCutRecordsAreTold("tiny_room.rawlog"); }
TEST(Truncation, EveryLengthOfTheRecordsOfACamera) { expectCutRecordsAreTold("tiny_handheld.rawlog"); }

// Cut as it is, gzipped: what could be inflated is used.
TEST(Truncation, AGzippedRawlogGivesEachRecordBeforeItsEnd) {
  for (const char* name : {"tiny_room.rawlog", "tiny_handheld.rawlog"}) {
    const TemporaryFolder folder;
    const std::string whole = readBytes(kRawlogs / name);
    const int all = readAll(kRawlogs / name).records;
    constexpr std::size_t kLengths = 12;
    int before = 0;
    for (std::size_t i = 1; i <= kLengths; ++i) {
      const std::size_t length = (whole.size() - 1) * i / kLengths;
      const auto read = readAll(folder.write("cut.rawlog", whole.substr(0, length)));
      EXPECT_GE(read.records, before) << name << " " << length;
      EXPECT_FALSE(read.warning.empty()) << name << " " << length;
      // Records are of about one size over the file.
      EXPECT_NEAR(read.records, all * static_cast<double>(i) / kLengths, 0.12 * all) << name << " " << length;
      before = read.records;
    }
    EXPECT_EQ(before, all) << "only the end of the checksum is missing";
  }
}

TEST(Truncation, EveryLengthOfAMapIsRefused) {
  const TemporaryFolder folder;
  const auto file = folder.file("map.rgmap");
  std::filesystem::copy_file(kRawlogs / "tiny_room.rgmap", file);
  EXPECT_FALSE(loadMap(file).landmarks.empty());
  for (std::size_t length = std::filesystem::file_size(file); length-- > 0;) {
    std::filesystem::resize_file(file, length);
    ASSERT_THAT(messageOf<InputError>([&] { loadMap(file); }), ::testing::HasSubstr("map.rgmap: ")) << length;
  }
}

}  // namespace
}  // namespace roomgraph::test
