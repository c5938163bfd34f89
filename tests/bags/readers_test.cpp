// SPDX-License-Identifier: BSD-3-Clause
// Both readers as streams: what is wanted, beginnings of messages, order, progress; bags of our own writer.
#include <gmock/gmock.h>

#include <map>

#include "bag_maker.h"
#include "bag_reader.h"
#include "bag_writer.h"
#include "byte_writer.h"
#include "errors_of.h"
#include "message_writing.h"
#include "roomgraph/core/errors.h"

namespace roomgraph::bags {
namespace {

using namespace roomgraph::test;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Key;

std::map<std::string, int> countsOf(BagReader& reader) {
  std::map<std::string, int> counts;
  for (RawMessage message; reader.next(message);) ++counts[reader.topics()[message.topic].name];
  return counts;
}

class BothReaders : public ::testing::TestWithParam<const char*> {
 protected:
  std::filesystem::path bag() {
    return makeBag(folder_, GetParam(),
                   std::string(GetParam()).find("ros2") == std::string::npos ? "x.bag" : "x.db3");
  }
  TemporaryFolder folder_;
};

TEST_P(BothReaders, GiveEveryMessageInItsOrder) {
  const auto reader = openBag(bag());
  std::int64_t before = 0;
  double progress = 0;
  int count = 0;
  for (RawMessage message; reader->next(message); ++count) {
    EXPECT_GE(message.received_ns, before - 100'000'000) << "a scan comes 20 ms after the frame of its time";
    EXPECT_GE(reader->progress(), progress);
    EXPECT_LE(reader->progress(), 1);
    before = message.received_ns;
    progress = reader->progress();
  }
  EXPECT_EQ(count, 2 + 20 * 8);
  EXPECT_THAT(reader->problems(), IsEmpty());
  RawMessage none;
  EXPECT_FALSE(reader->next(none)) << "still at the end";
}

TEST_P(BothReaders, GiveWhatIsWanted) {
  const auto reader = openBag(bag());
  reader->wants([](const BagTopic& topic) {
    return topic.type == "sensor_msgs/LaserScan" ? Want::kAll : Want::kNothing;
  });
  EXPECT_THAT(countsOf(*reader), ElementsAre(::testing::Pair("/scan", 20)));
}

TEST_P(BothReaders, GiveBeginningsOfImages) {
  const auto path = bag();
  const auto whole = openBag(path), beginning = openBag(path);
  beginning->wants([](const BagTopic&) { return Want::kBeginning; });
  RawMessage a, b;
  int cut = 0;
  while (whole->next(a)) {
    ASSERT_TRUE(beginning->next(b));
    ASSERT_EQ(b.bytes.size(), std::min(a.bytes.size(), kBeginningBytes));
    EXPECT_TRUE(std::equal(b.bytes.begin(), b.bytes.end(), a.bytes.begin()));
    if (beginning->topics()[b.topic].type != "sensor_msgs/Image") continue;
    ++cut;
    const auto head = imageHeadOf(b, false);
    EXPECT_EQ(head.width, 16u);
    EXPECT_EQ(head.height, 12u);
  }
  EXPECT_EQ(cut, 40);
}

INSTANTIATE_TEST_SUITE_P(Bags, BothReaders,
                         ::testing::Values("{}", R"({"compression": "lz4"})", R"({"ros2": "<"})"));

TEST(BagWriterStream, ManyChunksComeBackWithTheirTimes) {
  const TemporaryFolder folder;
  BagWriter writer(folder.file("x.bag"));
  const cv::Mat image(200, 300, CV_16UC1, cv::Scalar(7));
  for (int i = 0; i < 40; ++i) {
    const std::int64_t t = 1'000'000'000 + std::int64_t{i} * 33'333'333;
    writer.write("/depth", "sensor_msgs/Image", t, imageBytes(image, t, "eye"));
    writer.write("/pose", "geometry_msgs/PoseStamped", t + 1,
                 poseBytes(poseFromYpr(i, 0, 0, 0, 0, 0), t + 1, "world"));
  }
  EXPECT_FALSE(std::filesystem::exists(folder.file("x.bag"))) << "not before it is whole";
  writer.finish();
  EXPECT_THAT(writer.messages(), ElementsAre(::testing::Pair("/depth", 40), ::testing::Pair("/pose", 40)));
  const auto reader = openBag(folder.file("x.bag"));
  int poses = 0;
  for (RawMessage message; reader->next(message);) {
    EXPECT_EQ(headerOf(message).stamp_ns, message.received_ns);
    if (reader->topics()[message.topic].name == "/depth")
      EXPECT_EQ(imageOf(message, false).data.size(), 200u * 300 * 2);
    else
      EXPECT_EQ(decode<PoseMessage>(message).pose.translation().x(), poses++);
  }
  EXPECT_EQ(poses, 40);
  EXPECT_THAT(reader->problems(), IsEmpty());
}

TEST(BagWriterStream, WhatIsNotFinishedLeavesTheFormerFile) {
  const TemporaryFolder folder;
  folder.write("x.bag", "former");
  {
    BagWriter writer(folder.file("x.bag"));
    writer.write("/pose", "geometry_msgs/PoseStamped", 1, poseBytes(Pose3::Identity(), 1, "world"));
  }
  EXPECT_EQ(folder.read("x.bag"), "former");
  EXPECT_EQ(folder.count(), 1u);
  EXPECT_THROW(BagWriter(folder.file("nowhere/x.bag")), RunError);
}

TEST(BagWriterStream, AnEmptyBagIsABag) {
  const TemporaryFolder folder;
  BagWriter writer(folder.file("x.bag"));
  writer.finish();
  const auto reader = openBag(folder.file("x.bag"));
  EXPECT_THAT(countsOf(*reader), IsEmpty());
  EXPECT_THAT(reader->problems(), IsEmpty());
}

TEST(Ros2Folder, FilesAreReadByNumberAndTopicsAreOne) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.file("rec"));
  for (const char* number : {"10", "9"})
    makeBag(folder, R"({"ros2": "<", "seconds": 0.5})", std::string("rec/rec_") + number + ".db3");
  EXPECT_THAT(filesOfBag(folder.file("rec")),
              ElementsAre(folder.file("rec/rec_9.db3"), folder.file("rec/rec_10.db3")));
  const auto reader = openBag(folder.file("rec"));
  const auto counts = countsOf(*reader);
  EXPECT_EQ(counts.at("/scan"), 10);
  EXPECT_EQ(counts.size(), reader->topics().size());
  EXPECT_DOUBLE_EQ(reader->progress(), 1);
}

TEST(Ros2Folder, OneThatIsCompressedSaysSo) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.file("rec"));
  folder.write("rec/rec_0.db3.zstd", "\x28\xb5\x2f\xfd....");
  EXPECT_THAT(messageOf<InputError>([&] { openBag(folder.file("rec")); }),
              ::testing::HasSubstr("rec_0.db3.zstd: is compressed (zstd)"));
  makeBag(folder, R"({"ros2": "<", "seconds": 0.2})", "rec/rec_0.db3");
  EXPECT_EQ(countsOf(*openBag(folder.file("rec"))).at("/scan"), 2) << "the one that can be read is";
}

}  // namespace
}  // namespace roomgraph::bags
