// SPDX-License-Identifier: BSD-3-Clause
// MCAP: the same messages as in SQLite storage, whatever the chunks; files that are cut or damaged.
#include <gmock/gmock.h>

#include <random>

#include "bag_maker.h"
#include "errors_of.h"
#include "mcap_maker.h"
#include "roomgraph/core/allocation_limit.h"
#include "roomgraph/core/errors.h"

namespace roomgraph::bags {
namespace {

using namespace roomgraph::test;
using mrpt::obs::CObservationOdometry;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct Told {
  std::vector<std::string> messages;  ///< topic, type, time, content
  std::vector<std::string> problems;
};

Told allOf(BagReader& reader) {
  Told out;
  double progress = 0;
  for (RawMessage message; reader.next(message);) {
    const BagTopic& topic = reader.topics()[message.topic];
    out.messages.push_back(topic.name + " " + topic.type + " " + std::to_string(message.received_ns) +
                           (message.cdr ? " cdr " : " ros1 ") +
                           std::string(message.bytes.begin(), message.bytes.end()));
    EXPECT_GE(reader.progress(), progress);
    progress = reader.progress();
    EXPECT_LE(progress, 1);
  }
  out.problems = reader.problems();
  return out;
}

class Mcap : public ::testing::Test {
 protected:
  Told read(const std::string& bytes) { return allOf(*openBag(folder_.write("x.mcap", bytes))); }
  // Numbered messages of 100 bytes in chunks of ten.
  static std::string numbered(const McapOptions& options, int count = 50) {
    McapMaker maker(options);
    const auto id = maker.channel("/n", "std_msgs/msg/String");
    for (int i = 0; i < count; ++i)
      maker.message(id, 1000u + static_cast<unsigned>(i),
                    std::string(90, static_cast<char>('A' + i % 26)) + "0123456789");
    return maker.bytes();
  }
  TemporaryFolder folder_;
};

TEST_F(Mcap, GivesTheMessagesOfTheSameBagInSqlite) {
  for (const char* json : {R"({"ros2": "<"})", R"({"ros2": ">", "color": "png", "depth": "rvl"})"}) {
    const auto sqlite = makeBag(folder_, json, "x.db3");
    const Told expected = allOf(*openBag(sqlite));
    ASSERT_GT(expected.messages.size(), 100u);
    for (const McapOptions& options :
         {McapOptions{}, McapOptions{.chunk_bytes = 0}, McapOptions{.compression = "lz4"},
          McapOptions{.compression = "zstd", .chunk_bytes = 100'000},
          McapOptions{.compression = "zstd", .checksums = false}}) {
      const Told told = read(mcapOf(sqlite, options));
      EXPECT_EQ(told.messages, expected.messages) << options.compression << " " << options.chunk_bytes;
      EXPECT_THAT(told.problems, IsEmpty());
    }
  }
}

TEST_F(Mcap, OfRos1MessagesIsReadAsThese) {
  const auto bag = makeBag(folder_, "{}", "x.bag");
  const Told expected = allOf(*openBag(bag));
  EXPECT_EQ(read(mcapOf(bag, {.compression = "zstd"})).messages, expected.messages);
}

TEST_F(Mcap, IsImportedLikeSqlite) {
  const auto sqlite = makeBag(folder_, R"({"ros2": "<"})", "x.db3");
  std::filesystem::create_directory(folder_.file("bag"));
  folder_.write("bag/bag_0.mcap", mcapOf(sqlite, {.compression = "zstd"}));
  const auto expected = importBag(sqlite, folder_.file("a.rawlog"));
  const auto result = importBag(folder_.file("bag"), folder_.file("b.rawlog"));
  EXPECT_EQ(result.warnings, expected.warnings);
  EXPECT_EQ(folder_.read("a.rawlog"), folder_.read("b.rawlog"));
}

TEST_F(Mcap, GivesWhatIsWanted) {
  for (const std::size_t chunk_bytes : {0, 3000}) {
    folder_.write("x.mcap",
                  mcapOf(makeBag(folder_, R"({"ros2": "<"})", "x.db3"), {.chunk_bytes = chunk_bytes}));
    const auto reader = openBag(folder_.file("x.mcap"));
    reader->wants([](const BagTopic& topic) {
      return topic.type == "sensor_msgs/LaserScan" ? Want::kAll
             : topic.type == "sensor_msgs/Image"   ? Want::kBeginning
                                                   : Want::kNothing;
    });
    int scans = 0, images = 0, cut = 0;
    for (RawMessage message; reader->next(message);) {
      const bool image = reader->topics()[message.topic].type == "sensor_msgs/Image";
      ++(image ? images : scans);
      cut += image && message.bytes.size() == kBeginningBytes;
      EXPECT_TRUE(!image || message.bytes.size() <= kBeginningBytes);
    }
    EXPECT_EQ(scans, 20);
    EXPECT_EQ(images, 40);
    EXPECT_EQ(cut, 20) << "images of depth are shorter";
  }
}

TEST_F(Mcap, FilesOfOneRecordingAreReadByNumber) {
  std::filesystem::create_directory(folder_.file("rec"));
  folder_.write("rec/rec_10.mcap", numbered({}, 3));
  folder_.write("rec/rec_9.mcap", numbered({.compression = "lz4"}, 4));
  EXPECT_THAT(filesOfBag(folder_.file("rec")),
              ElementsAre(folder_.file("rec/rec_9.mcap"), folder_.file("rec/rec_10.mcap")));
  const auto reader = openBag(folder_.file("rec"));
  EXPECT_EQ(allOf(*reader).messages.size(), 7u);
  EXPECT_EQ(reader->topics().size(), 1u);
  EXPECT_DOUBLE_EQ(reader->progress(), 1);
}

TEST_F(Mcap, WhatIsNotKnownIsSteppedOver) {
  McapMaker maker({});
  maker.raw(mcapRecord(0x09, std::string(5000, 'x')));  // an attachment
  maker.raw(mcapRecord(0x99, "private"));
  const auto id = maker.channel("/a", ""), proto = maker.channel("/p", "a.B", "protobuf");
  maker.message(id, 1, "one");
  maker.message(proto, 2, "two");
  maker.message(proto, 3, "three");
  const Told told = read(maker.bytes());
  EXPECT_THAT(told.messages, ElementsAre("/a  1 cdr one"));
  EXPECT_THAT(told.problems, ElementsAre(HasSubstr("x.mcap: /p is left out: messages in 'protobuf'")));
}

TEST_F(Mcap, WithoutEndAllIsRead) {
  const Told told = read(numbered({.compression = "zstd", .end = false}));
  EXPECT_EQ(told.messages.size(), 50u);
  EXPECT_THAT(told.problems, ElementsAre(HasSubstr("x.mcap: no end: the recording was not ended properly")));
}

TEST_F(Mcap, CutAnywhereIsReadToThere) {
  for (const char* compression : {"", "lz4", "zstd"}) {
    const std::string whole = numbered({.compression = compression, .chunk_bytes = 1500, .end = false});
    std::size_t before = 0;
    for (std::size_t size = 9; size < whole.size(); size += 7) {
      const Told told = read(whole.substr(0, size));
      EXPECT_GE(told.messages.size(), before) << compression << " " << size;
      EXPECT_EQ(told.problems.size(), 1u) << compression << " " << size;
      EXPECT_THAT(told.problems,
                  Contains(::testing::AnyOf(HasSubstr("x.mcap: ends early: no whole record at byte"),
                                            HasSubstr("x.mcap: no end"))));
      before = told.messages.size();
    }
    EXPECT_GE(before, 40u);
  }
  // Of a chunk without compression every whole message is used.
  const std::string whole = numbered({.chunk_bytes = 100'000, .end = false});
  EXPECT_GE(read(whole.substr(0, whole.size() / 2)).messages.size(), 20u);
}

TEST_F(Mcap, AWrongChecksumCostsItsChunk) {
  std::string bytes = numbered({.chunk_bytes = 1000});
  const auto at = bytes.find("NNNN");
  bytes[at + 1] = 'x';
  const Told told = read(bytes);
  EXPECT_THAT(told.problems,
              ElementsAre(::testing::AllOf(HasSubstr("x.mcap: damaged at byte "),
                                           HasSubstr("a chunk is left out: its checksum is another"))));
  EXPECT_LT(told.messages.size(), 45u);
  std::string unknown = numbered({.chunk_bytes = 1000, .checksums = false});
  unknown[unknown.find("NNNN") + 1] = 'x';
  EXPECT_EQ(read(unknown).messages.size(), 50u) << "nothing says that it is damaged";
}

// Topics are defined in the first chunk, and once more behind the data.
TEST_F(Mcap, WithoutItsFirstChunkTheSummaryNamesTheTopics) {
  std::string bytes = numbered({.chunk_bytes = 1000, .summary = true});
  bytes[bytes.find("AAAA") + 1] = 'x';
  const Told told = read(bytes);
  EXPECT_THAT(told.problems, ElementsAre(HasSubstr("its checksum is another")));
  EXPECT_GE(told.messages.size(), 40u);
  std::string alone = numbered({.chunk_bytes = 1000});
  alone[alone.find("AAAA") + 1] = 'x';
  const Told lost = read(alone);
  EXPECT_THAT(lost.messages, IsEmpty());
  EXPECT_EQ(lost.problems.size(), 3u) << "no more than the first are told";
  EXPECT_THAT(lost.problems[1], HasSubstr("a message of no known topic"));
}

TEST_F(Mcap, DamageCostsItsChunkAndReadingGoesOn) {
  for (const char* compression : {"", "lz4", "zstd"}) {
    std::string bytes = numbered({.compression = compression, .chunk_bytes = 1000});
    auto at = bytes.find("\x07", bytes.size() / 3);
    while (bytes.compare(at + 1, 8, littleEndian(std::uint64_t{6})) != 0) at = bytes.find("\x07", at + 1);
    bytes.replace(at + 1, 8, std::string(8, '\x7f'));
    const Told told = read(bytes);
    EXPECT_THAT(told.problems, ElementsAre(HasSubstr("no record there; goes on at byte"))) << compression;
    EXPECT_EQ(told.messages.size(), 50u) << "an index is nothing that is read";
  }
}

TEST_F(Mcap, ChunksThatCannotBeReadAreTold) {
  McapMaker maker({});
  const auto id = maker.channel("/a", "std_msgs/msg/String");
  maker.message(id, 1, "one");
  maker.raw("");
  const std::string content = mcapRecord(0x05, std::string(22, '\1') + "lost");
  std::string unknown = maker.chunk(content, "lz4");
  unknown.replace(unknown.find("lz4"), 3, "xyz");
  maker.raw(unknown);
  std::string large = maker.chunk(content, "");
  large.replace(9 + 16, 8, littleEndian(std::uint64_t{1} << 40));
  maker.raw(large);
  maker.raw(maker.chunk(mcapRecord(0x05, littleEndian(std::uint16_t{77}) + std::string(24, ' ')), ""));
  maker.message(id, 2, "two");
  const Told told = read(maker.bytes());
  EXPECT_THAT(told.messages, ElementsAre(HasSubstr("one"), HasSubstr("two")));
  EXPECT_THAT(told.problems, ElementsAre(HasSubstr("compression 'xyz' is not known"),
                                         HasSubstr("1099511627776 bytes are too many for a chunk"),
                                         HasSubstr("a message of no known topic")));
}

TEST_F(Mcap, WhatIsNoMcapIsNamed) {
  EXPECT_THAT(messageOf<InputError>([&] { read("\x89MCAP1\r\n"); }),
              HasSubstr("x.mcap: is MCAP of another version than 0, or damaged at its beginning"));
  const Told nothing = read("\x89MCAP0\r\n");
  EXPECT_THAT(nothing.problems, ElementsAre(HasSubstr("x.mcap: no end")));
  EXPECT_THAT(messageOf<InputError>([&] { importBag(folder_.file("x.mcap"), folder_.file("x.rawlog")); }),
              HasSubstr("nothing in it can be imported"));
}

TEST_F(Mcap, ChangedBytesNeitherCrashNorFillTheMemory) {
  const auto sqlite =
      makeBag(folder_, R"({"ros2": "<", "seconds": 0.5, "color": "png", "depth": "rvl"})", "x.db3");
  for (const McapOptions& options :
       {McapOptions{.chunk_bytes = 0}, McapOptions{.compression = "lz4", .checksums = false},
        McapOptions{.compression = "zstd", .checksums = false}}) {
    const std::string whole = mcapOf(sqlite, options);
    std::mt19937 random(7);
    int read_any = 0;
    for (int round = 0; round < 60; ++round) {
      std::string bytes = whole;
      for (int change = 0; change < 1 + round % 8; ++change)
        bytes[random() % bytes.size()] = static_cast<char>(random());
      if (round % 3 == 0) bytes.resize(random() % bytes.size());
      try {
        const AllocationLimit limit(400u << 20);
        importBag(folder_.write("y.mcap", bytes), folder_.file("y.rawlog"));
        ++read_any;
      } catch (const Error&) {
      }
    }
    EXPECT_GT(read_any, 10) << options.compression;
  }
}

}  // namespace
}  // namespace roomgraph::bags
