// SPDX-License-Identifier: BSD-3-Clause
// Detection records: bit-exact replay, thresholds, masks, and FNV-1a test vectors.
#include "roomgraph/detection/detection_record.h"

#include <gmock/gmock.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>

#include <fstream>
#include <opencv2/core.hpp>

#include "recorded_detector.h"
#include "roomgraph/core/config.h"
#include "roomgraph/core/errors.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

ObjectDatabase chairsAndDoors() {
  return ObjectDatabase::fromText("[swivel_chair]\nlabels = chair\n[door]\nlabels = door\nshape = planar\n");
}

Frame frameAt(double t) {
  Frame frame;
  frame.t = t;
  frame.camera = {640, 480, 500, 500, 320, 240, {}};
  frame.sensor_label = "KINECT";
  return frame;
}

std::vector<Detection> found(unsigned seed) {
  cv::RNG random(seed);
  cv::Mat mask(57, 33, CV_8UC1);
  random.fill(mask, cv::RNG::UNIFORM, 0, 2);
  mask *= 255;
  return {{{10.1 / 3, 20.7 / 7, 36.6, 59.9}, "door", "door", 0.9000000001, mask, TrackId{4}},
          {{100, 200, 300.123456789012, 400}, "swivel_chair", "chair", 0.4, {}, {}}};
}

CObservationDetections throughAFile(const CObservationDetections& record) {
  mrpt::io::CMemoryStream stream;
  auto archive = mrpt::serialization::archiveFrom(stream);
  archive << record;
  stream.Seek(0);
  CObservationDetections back;
  archive >> back;
  return back;
}

TEST(DetectionRecord, ReplayGivesTheSameBits) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const Frame frame = frameAt(1700000000.123);
    const auto live = found(seed);
    const auto record = throughAFile(toRecord(frame, live, {"net", "0123", 0.35, 0.5}));
    EXPECT_EQ(record.image_label, "KINECT");
    EXPECT_EQ(record.image_width, 640u);
    EXPECT_EQ(record.model, "net");
    EXPECT_EQ(record.model_hash, "0123");
    const ObjectDatabase classes = chairsAndDoors();
    RecordedDetector detector;
    detector.setDatabase(classes);
    detector.prepare();
    detector.feed(record);
    const auto replayed = detector.detect(frame);
    ASSERT_TRUE(replayed);
    ASSERT_EQ(replayed->size(), live.size());
    for (std::size_t i = 0; i < live.size(); ++i) {
      EXPECT_EQ((*replayed)[i].box, live[i].box);
      EXPECT_EQ((*replayed)[i].score, live[i].score);
      EXPECT_EQ((*replayed)[i].class_name, live[i].class_name);
      EXPECT_EQ((*replayed)[i].label, live[i].label);
      EXPECT_EQ((*replayed)[i].track, live[i].track);
      EXPECT_EQ((*replayed)[i].mask.size(), live[i].mask.size());
      if (!live[i].mask.empty()) {
        EXPECT_EQ(cv::norm((*replayed)[i].mask, live[i].mask, cv::NORM_INF), 0) << "seed " << seed;
      }
    }
    EXPECT_EQ(detector.identity().hash, "0123");
    EXPECT_EQ(detector.warning(), "");
  }
}

// What was carried to a frame is carried there again by the replay.
TEST(DetectionRecord, ClassesThatWereNotLookedForAreSaid) {
  auto live = found(1);
  live[0].carried = true;
  const auto record = throughAFile(toRecord(frameAt(5), live, {}, {"door"}));
  ASSERT_EQ(record.items.size(), 1u);
  EXPECT_EQ(record.items[0].label, "chair");
  const ObjectDatabase classes = chairsAndDoors();
  RecordedDetector detector;
  detector.setDatabase(classes);
  detector.prepare();
  detector.feed(record);
  EXPECT_EQ(detector.detect(frameAt(5))->size(), 1u);
  EXPECT_EQ(detector.unsought(), std::vector<std::string>{"door"});
  EXPECT_FALSE(detector.detect(frameAt(9)));
  EXPECT_TRUE(detector.unsought().empty());
}

TEST(DetectionRecord, StricterThresholdsOfTheRecordingAreSaid) {
  RecordedDetector detector;
  Config::fromText("[detection]\nscore_threshold = 0.2\n", "test").read("detection", detector);
  const ObjectDatabase classes = chairsAndDoors();
  detector.setDatabase(classes);
  detector.prepare();
  detector.feed(toRecord(frameAt(1), {}, {"net", "", 0.35, 0.5}));
  EXPECT_THAT(detector.warning(),
              ::testing::AllOf(::testing::HasSubstr("0.35"), ::testing::HasSubstr("0.2")));
}

TEST(DetectionRecord, MaskRunsOfSpecialMasks) {
  const cv::Mat off = cv::Mat::zeros(3, 4, CV_8UC1), on = cv::Mat(3, 4, CV_8UC1, cv::Scalar(255));
  EXPECT_EQ(toRuns(off).runs, (std::vector<std::uint32_t>{12}));
  EXPECT_EQ(toRuns(on).runs, (std::vector<std::uint32_t>{0, 12}));
  EXPECT_EQ(cv::norm(toMask(toRuns(on)), on, cv::NORM_INF), 0);
  EXPECT_EQ(cv::countNonZero(toMask(toRuns(off))), 0);
  EXPECT_TRUE(toRuns(cv::Mat()).runs.empty());
  EXPECT_TRUE(toMask({}).empty());
  EXPECT_TRUE(toMask({4, 3, {5, 6}}).empty()) << "does not fill the picture";
  EXPECT_TRUE(toMask({1u << 20, 1u << 20, {1}}).empty());
  EXPECT_TRUE(toMask({1u << 15, 1u << 15, {1u << 30}}).empty()) << "a gigabyte out of three numbers";
}

// Published test vectors of 64-bit FNV-1a.
TEST(DetectionRecord, FileHash) {
  const test::TemporaryFolder folder;
  const auto hashOf = [&](const std::string& text) {
    std::ofstream(folder.file("x"), std::ios::binary) << text;
    return fileHash(folder.file("x").string());
  };
  EXPECT_EQ(hashOf(""), "cbf29ce484222325");
  EXPECT_EQ(hashOf("a"), "af63dc4c8601ec8c");
  EXPECT_EQ(hashOf("foobar"), "85944171f73967e8");
  EXPECT_THROW(fileHash(folder.file("missing").string()), InputError);
}

}  // namespace
}  // namespace roomgraph
