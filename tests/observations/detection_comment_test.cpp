// SPDX-License-Identifier: BSD-3-Clause
// Detections as comments: bit-exact round trip and damaged texts.
#include "roomgraph/observations/detection_comment.h"

#include <gtest/gtest.h>
#include <mrpt/core/Clock.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/serialization/CArchive.h>

#include <limits>

#include "random_poses.h"

namespace roomgraph {
namespace {

using mrpt::obs::CObservationComment;

std::string bytesOf(const CObservationDetections& detections) {
  mrpt::io::CMemoryStream stream;
  mrpt::serialization::archiveFrom(stream) << detections;
  return {static_cast<const char*>(stream.getRawBufferData()),
          static_cast<std::size_t>(stream.getTotalBytesCount())};
}

// As it comes out of a rawlog: MRPT 2.5 does not write a comment's label.
CObservationComment throughAFile(const CObservationComment& comment) {
  mrpt::io::CMemoryStream stream;
  auto archive = mrpt::serialization::archiveFrom(stream);
  archive << comment;
  stream.Seek(0);
  CObservationComment back;
  archive >> back;
  return back;
}

CObservationDetections randomDetections(unsigned seed) {
  test::Random random(seed);
  CObservationDetections out;
  out.timestamp = mrpt::Clock::fromDouble(1700000000.1 + seed);
  out.sensorLabel = "DETECTIONS";
  out.setSensorPose({random.uniform(-1, 1), 2, 3, random.uniform(-3, 3), 0.2, random.uniform(-1, 1)});
  out.image_label = "KINECT";
  out.image_width = 640;
  out.image_height = 480;
  out.model = "nanodet \"m\"\n+ \xc3\xa4";
  out.model_hash = "0123456789abcdef";
  out.score_threshold = 0.35f;
  out.nms_threshold = static_cast<float>(random.uniform(0, 1));
  for (int i = 0; i < 20; ++i) {
    CObservationDetections::Item item{"chair", random.uniform(0, 1)};
    for (double* side : {&item.u_min, &item.v_min, &item.u_max, &item.v_max})
      *side = random.uniform(-1, 640) / 3;
    if (i % 2 == 0) item.track = std::int64_t{1} << (3 * i);
    if (i % 3 == 0) item.mask = {3, 2, {1, 5}};
    out.items.push_back(item);
  }
  if (seed % 2 == 0) out.unsought = {"door", "person"};
  out.items.push_back({"extremes", std::numeric_limits<double>::denorm_min(), -0.0, 1 / 3.0, 1e300,
                       std::numeric_limits<double>::epsilon()});
  return out;
}

TEST(DetectionComment, EveryBitComesBack) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const auto before = randomDetections(seed);
    const auto comment = throughAFile(toComment(before));
    EXPECT_EQ(comment.timestamp, before.timestamp) << "other tools cut by time";
    ASSERT_TRUE(holdsDetections(comment));
    const auto back = fromComment(comment);
    ASSERT_TRUE(back) << back.reason();
    EXPECT_TRUE(bytesOf(**back) == bytesOf(before)) << comment.text;
  }
  const CObservationDetections none;
  const auto comment = throughAFile(toComment(none));
  EXPECT_EQ(toComment(**fromComment(comment)).text, comment.text);
}

TEST(DetectionComment, ALabelThatAToolChangedCounts) {
  auto comment = toComment(randomDetections(1));
  comment.sensorLabel = "RENAMED";
  EXPECT_EQ((*fromComment(comment))->sensorLabel, "RENAMED");
}

TEST(DetectionComment, NamesThatAreNoUtf8DoNotStopTheRecording) {
  auto odd = randomDetections(1);
  odd.model = "caf\xe9";
  const auto back = fromComment(toComment(odd));
  ASSERT_TRUE(back);
  EXPECT_TRUE((*back)->model.starts_with("caf"));
}

TEST(DetectionComment, OtherRecordsAreLeftAlone) {
  for (const char* text :
       {"", "recorded by Ada", "{\"robot\": \"rhodon\"}", " see \"roomgraph_detections\""}) {
    auto comment = std::make_shared<CObservationComment>();
    comment->text = text;
    EXPECT_FALSE(holdsDetections(*comment)) << text;
    EXPECT_EQ(*unpacked(comment), comment);
  }
  const auto odometry = mrpt::obs::CObservationOdometry::Create();
  EXPECT_EQ(*unpacked(odometry), odometry);
  const auto own = std::make_shared<CObservationDetections>();
  EXPECT_EQ(*unpacked(own), own) << "older recordings";
}

TEST(DetectionComment, DamagedTextsAreRefused) {
  const auto good = toComment(randomDetections(3));
  const auto replaced = [&](const std::string& from, const std::string& to) {
    auto comment = std::make_shared<CObservationComment>(good);
    const auto at = comment->text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    comment->text.replace(at, from.size(), to);
    return comment;
  };
  const std::vector<std::pair<std::string, std::string>> damages = {
      {"\"roomgraph_detections\":1", "\"roomgraph_detections\":2"},
      {"[640,480]", "[-640,480]"},
      {"[640,480]", "[1e12,480]"},
      {"[640,480]", "[640]"},
      {"\"width\":3", "\"width\":4294967296"},
      {"\"runs\":[1,5]", "\"runs\":[1,null]"},
      {"\"label\":\"chair\"", "\"label\":7"},
      {"\"score\":", "\"score\":1e999,\"x\":"},
      {"\"score\":", "\"score\":null,\"x\":"},
      {"\"model_hash\":", "\"hash\":"},
      {"\"items\":[", "\"items\":[{},"},
      {"]}", "]"}};
  for (const auto& [from, to] : damages) {
    const auto result = unpacked(replaced(from, to));
    EXPECT_FALSE(result) << from << " -> " << to;
    EXPECT_TRUE(result.reason().starts_with("broken record: CObservationComment: ")) << result.reason();
  }
  EXPECT_TRUE(unpacked(replaced("{", "\n  {"))) << "white space does no harm";
}

}  // namespace
}  // namespace roomgraph
