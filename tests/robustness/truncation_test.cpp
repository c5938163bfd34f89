// SPDX-License-Identifier: BSD-3-Clause
// Files that end too early: lengths of the records of the shipped rawlogs, every length of the shipped map.
#include <gmock/gmock.h>

#include <cstdlib>
#include <set>

#include "roomgraph/core/errors.h"
#include "roomgraph/datasets/stored_observations.h"
#include "roomgraph/observations/map_file.h"
#include "three_frames.h"

// Of the first record of each class every length is tried (in images one of 61 between their ends), of the
// others seven; of all records every one when the environment variable ROOMGRAPH_EVERY_TRUNCATION is set
// (hours).

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

bool everyOne() {
  return std::getenv("ROOMGRAPH_EVERY_TRUNCATION") != nullptr;
}

/// Lengths of a record that are tried: of the first of its class every one, but for the inside of images.
std::vector<std::size_t> lengthsOf(std::size_t size, bool first) {
  constexpr std::size_t kStepInImages = 61, kLengthsOfOthers = 7;
  std::vector<std::size_t> out;
  for (std::size_t length = size - 1; length > 0;) {
    out.push_back(length);
    const bool inside = length > kEndsOfImages && length + kEndsOfImages < size;
    std::size_t step = first ? 1 : size / kLengthsOfOthers;
    if (first && size > kLongRecord && inside) step = kStepInImages;
    length -= std::min(length, everyOne() ? 1 : step);
  }
  return out;
}

/// A sound record and then a record at its lengths: the first is used, the second told.
void expectLengths(const TemporaryFolder& folder, const std::string& before, const std::string& record,
                   bool first) {
  const auto file = folder.write("cut.rawlog", before + record);
  for (const std::size_t length : lengthsOf(record.size(), first)) {
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
  std::set<std::string> classes;
  for (const auto& record : records) {
    ASSERT_FALSE(record.empty());
    // A record begins with 0x80 | length of its class' name, and the name.
    const std::string class_name = record.substr(1, static_cast<unsigned char>(record[0]) & 0x7fu);
    expectLengths(folder, before, record, classes.insert(class_name).second);
  }
}

TEST(Truncation, EveryLengthOfTheRecordsOfARobot) {
  expectCutRecordsAreTold("tiny_room.rawlog");
}
TEST(Truncation, EveryLengthOfTheRecordsOfACamera) {
  expectCutRecordsAreTold("tiny_handheld.rawlog");
}

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

// The last bytes are gzip's: its end of data and its checksum. Without them the map may be whole, as its own
// checksum tells.
TEST(Truncation, EveryLengthOfAMapIsRefusedUnlessAllOfItIsThere) {
  const TemporaryFolder folder;
  const auto file = folder.file("map.rgmap");
  std::filesystem::copy_file(kRawlogs / "tiny_room.rgmap", file);
  const auto whole = loadMap(file);
  ASSERT_FALSE(whole.landmarks.empty());
  constexpr std::size_t kEndOfGzip = 16;
  const std::size_t size = std::filesystem::file_size(file);
  for (std::size_t length = size; length-- > 0;) {
    std::filesystem::resize_file(file, length);
    try {
      const auto map = loadMap(file);
      ASSERT_GE(length + kEndOfGzip, size);
      EXPECT_EQ(map.landmarks.size(), whole.landmarks.size());
      EXPECT_EQ(map.world_from_robot.size(), whole.world_from_robot.size());
    } catch (const InputError& error) {
      ASSERT_THAT(error.what(), ::testing::HasSubstr("map.rgmap: ")) << length;
      ASSERT_LT(length + kEndOfGzip / 2, size) << "only the checksum of gzip is missing";
    }
  }
}

}  // namespace
}  // namespace roomgraph::test
