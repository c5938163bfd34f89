// SPDX-License-Identifier: BSD-3-Clause
// Records from objects given one by one, against what the reader of a file makes of them.
#include "roomgraph/datasets/record_converter.h"

#include <gtest/gtest.h>
#include <mrpt/obs/CObservationOdometry.h>

#include "roomgraph/core/errors.h"
#include "roomgraph/datasets/rawlog_objects.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

const std::filesystem::path kTinyRoom = ROOMGRAPH_SOURCE_DIR "/rawlogs/tiny_room.rawlog";

TEST(RecordConverter, MakesOfObjectsWhatTheReaderMakesOfTheirFile) {
  RawlogReader reader(kTinyRoom);
  RawlogObjects objects(kTinyRoom);
  RecordConverter converter({}, kTinyRoom);
  const auto expectNext = [&](const Record& record) {
    const auto expected = reader.next();
    ASSERT_TRUE(expected);
    EXPECT_EQ(record.index(), expected->index());
    EXPECT_EQ(timeOf(record), timeOf(*expected));
    if (const auto* scan = std::get_if<Scan>(&record)) {
      EXPECT_EQ(scan->ranges_m, std::get<Scan>(*expected).ranges_m);
    }
    if (const auto* frame = std::get_if<Frame>(&record)) {
      EXPECT_EQ(frame->id, std::get<Frame>(*expected).id);
    }
  };
  int records = 0;
  const auto drain = [&] {
    for (; const auto record = converter.next(); ++records) expectNext(*record);
  };
  while (const auto object = objects.next()) {
    converter.take(object);
    drain();
  }
  converter.end();
  drain();
  EXPECT_GT(records, 150);
  EXPECT_FALSE(reader.next());
  EXPECT_EQ(converter.statistics().used, reader.statistics().used);
  EXPECT_EQ(converter.statistics().skipped, reader.statistics().skipped);
  EXPECT_EQ(objects.progress(), 1);
  EXPECT_TRUE(objects.skipped().empty());
  EXPECT_EQ(objects.truncation(), "");
}

TEST(RecordConverter, CountsWhatItCannotUse) {
  RecordConverter converter;
  auto reading = mrpt::obs::CObservationOdometry::Create();
  reading->timestamp = INVALID_TIMESTAMP;
  converter.take(reading);
  converter.take(nullptr);
  converter.skip("broken");
  converter.end("cut");
  EXPECT_FALSE(converter.next());
  const auto& statistics = converter.statistics();
  EXPECT_EQ(statistics.skipped.at("CObservationOdometry: invalid time stamp"), 1);
  EXPECT_EQ(statistics.skipped.at("empty object: not used"), 1);
  EXPECT_EQ(statistics.skipped.at("broken"), 1);
  EXPECT_EQ(statistics.warning, "cut");
}

TEST(RawlogObjects, SaysWhereACutFileEnds) {
  const test::TemporaryFolder folder;
  std::ifstream in(kTinyRoom, std::ios::binary);
  std::string bytes(400000, '\0');
  in.read(bytes.data(), 400000);
  folder.write("cut.rawlog", bytes);
  RawlogObjects objects(folder.file("cut.rawlog"));
  int count = 0;
  while (objects.next()) ++count;
  EXPECT_GT(count, 10);
  EXPECT_NE(objects.truncation().find("the file ends in the middle of a record"), std::string::npos);
  EXPECT_THROW(RawlogObjects(folder.file("none.rawlog")), InputError);
}

}  // namespace
}  // namespace roomgraph
