// SPDX-License-Identifier: BSD-3-Clause
// Bags that are cut, without index, changed in single bytes or none at all: what is usable is used, told in
// one line, with bounded memory.
#include <gmock/gmock.h>

#include <fstream>
#include <random>

#include "bag_maker.h"
#include "bag_reader.h"
#include "errors_of.h"
#include "image_decoding.h"
#include "roomgraph/core/allocation_limit.h"
#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

using namespace roomgraph::test;
using mrpt::obs::CObservationOdometry;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class DamagedBag : public ::testing::Test {
 protected:
  BagImportResult import(const std::string& bytes, const std::string& name = "y.bag") {
    return importBag(folder_.write(name, bytes), folder_.file("y.rawlog"));
  }
  std::size_t wheels() { return only<CObservationOdometry>(recordsIn(folder_.file("y.rawlog"))).size(); }
  std::string bytesOfBag(const std::string& json = "{}", const std::string& name = "x.bag") {
    makeBag(folder_, json, name);
    return folder_.read(name);
  }
  std::string inputError(const std::string& bytes, const std::string& name = "y.bag") {
    return messageOf<InputError>([&] { import(bytes, name); });
  }
  TemporaryFolder folder_;
};

TEST_F(DamagedBag, TruncatedIsReadToItsEnd) {
  const std::string whole = bytesOfBag();
  const auto result = import(whole.substr(0, whole.size() / 2));
  EXPECT_THAT(result.warnings, Contains(HasSubstr("y.bag: ends early: the index would begin at byte")));
  EXPECT_GE(wheels(), 7u);
  EXPECT_LT(wheels(), 20u);
}

// As a recorder that is killed leaves it: no position of an index in its first record, and none at its end.
TEST_F(DamagedBag, WithoutIndexAllIsRead) {
  std::string bytes = bytesOfBag();
  const auto at = bytes.find("index_pos=") + 10;
  std::uint64_t index = 0;
  std::memcpy(&index, bytes.data() + at, sizeof index);
  bytes.resize(index);
  bytes.replace(at, 8, std::string(8, '\0'));
  const auto result = import(bytes);
  EXPECT_THAT(result.warnings,
              ::testing::ElementsAre(HasSubstr("y.bag: no index: the recording was not ended properly")));
  EXPECT_EQ(wheels(), 20u);
}

TEST_F(DamagedBag, ADamagedPlaceCostsItsChunk) {
  for (const char* json : {"{}", R"({"compression": "bz2"})", R"({"compression": "lz4"})"}) {
    std::string bytes = bytesOfBag(json);
    const auto second = bytes.find("compression=", bytes.find("compression=") + 1);
    bytes.replace(second + 200, 40, std::string(40, '\xff'));
    const auto result = import(bytes);
    EXPECT_THAT(result.warnings, Contains(HasSubstr("y.bag: damaged at byte"))) << json;
    EXPECT_GE(wheels(), 14u) << json;
  }
}

TEST_F(DamagedBag, WhatIsNoBagIsNamed) {
  std::filesystem::create_directory(folder_.file("empty"));
  EXPECT_THAT(inputError(""), HasSubstr("y.bag: is empty"));
  EXPECT_THAT(inputError("hello"),
              HasSubstr("is no bag, neither of ROS 1 (.bag) nor of ROS 2 (.db3, .mcap)"));
  EXPECT_THAT(inputError("#ROSBAG V1.2\n"), HasSubstr("another version (ROSBAG V1.2); `rosbag fix`"));
  EXPECT_THAT(inputError("#ROSBAG V2.0\n"), HasSubstr("nothing in it can be imported"));
  EXPECT_THAT(inputError("\x28\xb5\x2f\xfd....", "y.db3.zstd"),
              HasSubstr("is compressed (zstd); `ros2 bag convert`"));
  EXPECT_THAT(inputError("SQLite format 3", "y.db3"), HasSubstr("y.db3: is no bag of ROS 2, or damaged"));
  EXPECT_THAT(messageOf<InputError>([&] { importBag(folder_.file("none.bag"), folder_.file("y.rawlog")); }),
              HasSubstr("none.bag: no such file"));
  EXPECT_THAT(messageOf<InputError>([&] { importBag(folder_.file("empty"), folder_.file("y.rawlog")); }),
              HasSubstr("no bag in this folder"));
  EXPECT_FALSE(std::filesystem::exists(folder_.file("y.rawlog")));
}

TEST_F(DamagedBag, AFolderOfRos2IsReadInItsOrder) {
  std::filesystem::create_directory(folder_.file("bag"));
  makeBag(folder_, R"({"ros2": "<"})", "bag/rec_0.db3");
  folder_.write("bag/metadata.yaml", "rosbag2_bagfile_information:\n");
  const auto result = importBag(folder_.file("bag"), folder_.file("y.rawlog"));
  EXPECT_THAT(result.warnings, IsEmpty());
  EXPECT_EQ(wheels(), 20u);
  const std::string whole = folder_.read("bag/rec_0.db3");
  folder_.write("bag/rec_0.db3", whole.substr(0, whole.size() / 2 / 4096 * 4096));
  try {
    const auto cut = importBag(folder_.file("bag"), folder_.file("y.rawlog"));
    EXPECT_THAT(cut.warnings, Contains(HasSubstr("rec_0.db3: ends early:")));
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("rec_0.db3"));
  }
}

// Changes of bytes anywhere may cost records, but neither memory nor the process.
TEST_F(DamagedBag, ChangedBytesNeitherCrashNorFillTheMemory) {
  for (const char* json : {"{}", R"({"compression": "bz2", "color": "png", "depth": "rvl"})",
                           R"({"compression": "lz4", "depth": "compressedDepth"})",
                           R"({"ros2": "<", "color": "png", "depth": "rvl"})", R"({"ros2": ">"})"}) {
    const bool ros2 = std::string(json).find("ros2") != std::string::npos;
    const std::string whole = bytesOfBag(json, ros2 ? "x.db3" : "x.bag");
    std::mt19937 random(7);
    int read = 0;
    for (int round = 0; round < 60; ++round) {
      std::string bytes = whole;
      for (int change = 0; change < 1 + round % 8; ++change)
        bytes[random() % bytes.size()] = static_cast<char>(random());
      if (round % 3 == 0) bytes.resize(random() % bytes.size());
      try {
        const AllocationLimit limit(400u << 20);
        import(bytes, ros2 ? "y.db3" : "y.bag");
        ++read;
      } catch (const Error&) {
      }
    }
    EXPECT_GT(read, 10) << json;
  }
}

// Each length in a message that claims more than the message has.
TEST(DamagedMessage, EveryBeginningOfAMessageIsRefused) {
  const TemporaryFolder folder;
  for (const char* json : {R"({"depth": "rvl"})", R"({"ros2": ">", "depth": "rvl"})"}) {
    const auto bag = makeBag(folder, json, json[2] == 'd' ? "x.bag" : "x.db3");
    const auto reader = bags::openBag(bag);
    for (bags::RawMessage message; reader->next(message);) {
      const auto& topic = reader->topics()[message.topic];
      const auto read = [&](const bags::RawMessage& part) {
        if (topic.type == "sensor_msgs/Image") bags::colorImageOf(bags::imageOf(part, false), false);
        if (topic.type == "sensor_msgs/CompressedImage") bags::depthImageOf(bags::imageOf(part, true), true);
        if (topic.type == "sensor_msgs/LaserScan") bags::decode<bags::LaserScanMessage>(part);
        if (topic.type == "sensor_msgs/Imu") bags::decode<bags::ImuMessage>(part);
        if (topic.type == "nav_msgs/Odometry") bags::decode<bags::OdometryMessage>(part);
        if (topic.type == "tf2_msgs/TFMessage") bags::decode<bags::TransformsMessage>(part);
      };
      if (topic.type == "std_msgs/String" || topic.type == "sensor_msgs/CameraInfo" || topic.name == "/odom")
        continue;
      EXPECT_NO_THROW(read(message)) << topic.name;
      for (std::size_t size = 0; size + 8 < message.bytes.size(); size += 1 + size / 16) {
        bags::RawMessage part = message;
        part.bytes = message.bytes.first(size);
        EXPECT_THROW(read(part), bags::BadMessage) << topic.name << " " << size;
      }
    }
  }
}

}  // namespace
}  // namespace roomgraph
