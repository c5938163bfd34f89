// SPDX-License-Identifier: BSD-3-Clause
// RecordedDetector: matching by time and camera, JSON and text files, masks.
#include "recorded_detector.h"

#include <gmock/gmock.h>
#include <mrpt/core/Clock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "errors_of.h"
#include "roomgraph/core/config.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/observations/detection_comment.h"
#include "roomgraph/observations/rawlog_writer.h"

namespace roomgraph {
namespace {

using ::testing::HasSubstr;

const ObjectDatabase& chairsAndSofas() {
  static const ObjectDatabase db = ObjectDatabase::fromText(
      "[swivel_chair]\nlabels = chair\nshape = cylinder\n[sofa]\nlabels = couch, sofa\n");
  return db;
}

class RecordedDetectorTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("roomgraph_recorded_" + std::to_string(getpid()) + "_" +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& text) {
    const auto file = folder_ / "boxes";
    std::ofstream(file) << text;
    return file.string();
  }
  void prepare(const std::string& ini) {
    Config::fromText("[detection]\n" + ini, "test").read("detection", detector_);
    detector_.setDatabase(chairsAndSofas());
    detector_.prepare();
  }
  static Frame frameAt(double t, const std::string& label = "") {
    Frame frame;
    frame.t = t;
    frame.camera = {640, 480, 500, 500, 320, 240, {}};
    frame.sensor_label = label;
    return frame;
  }
  static CObservationDetections record(double t, const std::string& label, const std::string& camera = "") {
    CObservationDetections out;
    out.timestamp = mrpt::Clock::fromDouble(t);
    out.image_label = camera;
    out.items.push_back({label, 0.9f, 10, 20, 110, 220, 7});
    return out;
  }

  std::filesystem::path folder_;
  RecordedDetector detector_;
};

// What `run --save-detections` writes: it stands for what the recording holds.
TEST_F(RecordedDetectorTest, ARawlogOfDetectionsReplacesThoseOfTheRecording) {
  const auto file = folder_ / "boxes.rawlog";
  {
    RawlogWriter writer(file);
    writer.write(toComment(record(10, "chair")));
    CObservationDetections second = record(11, "sofa");
    second.model = "net";
    second.model_hash = "f00";
    writer.write(toComment(second));
    writer.finish();
  }
  prepare("file = " + file.string());
  EXPECT_FALSE(detector_.empty());
  detector_.feed(record(10, "sofa"));
  detector_.feed(record(12, "sofa"));
  ASSERT_TRUE(detector_.detect(frameAt(10)).ok());
  ASSERT_EQ(detector_.detect(frameAt(10))->size(), 1u);
  EXPECT_EQ(detector_.detect(frameAt(10))->front().class_name, "swivel_chair");
  EXPECT_EQ(detector_.detect(frameAt(11))->front().class_name, "sofa");
  EXPECT_FALSE(detector_.detect(frameAt(12)).ok()) << "only the recording has it";
  EXPECT_EQ(detector_.identity().model, "net");
  EXPECT_EQ(detector_.identity().hash, "f00");
}

TEST_F(RecordedDetectorTest, ARawlogThatIsNoneIsAnError) {
  const auto file = folder_ / "boxes.rawlog";
  const auto problem = [&] {
    try {
      prepare("file = " + file.string());
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(problem(), HasSubstr("boxes.rawlog: cannot be read"));
  std::ofstream(file) << std::string(100, 'x');
  EXPECT_THAT(problem(), HasSubstr("boxes.rawlog: is no rawlog of detections"));
}

TEST_F(RecordedDetectorTest, BoxesThatComeTooLateAreReported) {
  prepare("score_threshold = 0.3");
  detector_.feed(record(10, "chair"));
  ASSERT_TRUE(detector_.detect(frameAt(10)));
  EXPECT_EQ(detector_.warning(), "");
  EXPECT_FALSE(detector_.detect(frameAt(11)));
  EXPECT_FALSE(detector_.detect(frameAt(12)));
  detector_.feed(record(11, "chair"));
  detector_.feed(record(12, "chair"));
  EXPECT_THAT(detector_.warning(), HasSubstr("boxes that came after images of up to 1.00 s later, too late for their own: of 1 image;"));
  EXPECT_THAT(detector_.warning(), HasSubstr("[pipeline] lookahead_s"));
}

TEST_F(RecordedDetectorTest, LabelsOfNoClassAreRivals) {
  prepare("score_threshold = 0.3");
  CObservationDetections both = record(10, "chair");
  both.items.push_back({"printer", 0.95F, 12, 20, 112, 220, 8});
  both.items.push_back({"tv", 0.2F, 10, 20, 110, 220, 9});
  detector_.feed(both);
  const auto found = detector_.detect(frameAt(10));
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 1u);
  EXPECT_FLOAT_EQ(static_cast<float>((*found)[0].rival_score), 0.95F);
}

TEST_F(RecordedDetectorTest, RivalsOfAFileAreRivals) {
  const auto with = [this](const std::string& rival) {
    prepare("file = " + write(R"({"timestamp": 10, "boxes": [{"class": "swivel_chair", "score": 0.8, "bbox": [10, 20, 110, 220], "rival": )" +
                              rival + R"(}, {"class": "sofa", "score": 0.7, "bbox": [200, 20, 310, 220]}]})"));
  };
  with(R"({"label": "printer", "score": 0.6})");
  const auto found = detector_.detect(frameAt(10));
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 2u);
  EXPECT_EQ((*found)[0].rival_label, "printer");
  EXPECT_EQ((*found)[0].rival_score, 0.6);
  EXPECT_EQ((*found)[1].rival_score, 0);
  for (const std::string rival : {R"({"label": "printer", "score": 2})", R"({"score": 0.6})", "7"})
    EXPECT_THAT(test::messageOf<InputError>([&] { with(rival); }), HasSubstr("boxes:1")) << rival;
}

TEST_F(RecordedDetectorTest, NearestRecordWinsBeforeOrAfterTheFrame) {
  prepare("tolerance_s = 0.05");
  detector_.feed(record(9.97, "couch"));
  detector_.feed(record(10.01, "chair"));
  const auto found = detector_.detect(frameAt(10.0));
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 1u);
  EXPECT_EQ((*found)[0].class_name, "swivel_chair");
  EXPECT_EQ((*found)[0].label, "chair");
  EXPECT_EQ((*found)[0].track.value, 7);
  EXPECT_EQ((*found)[0].box, (Box2{10, 20, 110, 220}));
  EXPECT_EQ((*detector_.detect(frameAt(9.98)))[0].class_name, "sofa");
}

TEST_F(RecordedDetectorTest, WhatIsLongPastIsGivenUp) {
  prepare("tolerance_s = 0.05");
  for (const double t : {10.0, 45.0, 100.0}) detector_.feed(record(t, "chair"));
  EXPECT_TRUE(detector_.detect(frameAt(10)));
  EXPECT_TRUE(detector_.detect(frameAt(100)));
  EXPECT_TRUE(detector_.detect(frameAt(45))) << "a frame that comes late";
  EXPECT_FALSE(detector_.detect(frameAt(10)));
}

TEST_F(RecordedDetectorTest, OutsideTheToleranceThereIsAReason) {
  prepare("tolerance_s = 0.05");
  EXPECT_FALSE(detector_.detect(frameAt(10.0)));
  detector_.feed(record(10.0, "chair"));
  const auto missing = detector_.detect(frameAt(10.06));
  EXPECT_FALSE(missing);
  EXPECT_THAT(missing.reason(), HasSubstr("0.05 s"));
}

TEST_F(RecordedDetectorTest, RecordsOfAnotherCameraAreIgnored) {
  prepare("");
  detector_.feed(record(10.0, "couch", "REAR"));
  EXPECT_FALSE(detector_.detect(frameAt(10.0, "FRONT")));
  detector_.feed(record(10.0, "chair", "FRONT"));
  EXPECT_EQ((*detector_.detect(frameAt(10.0, "FRONT")))[0].class_name, "swivel_chair");
}

TEST_F(RecordedDetectorTest, JsonLinesAreClippedFilteredAndSorted) {
  prepare(
      "score_threshold = 0.3\nfile = " +
      write(
          R"({"timestamp": 5.0, "boxes": [{"class": "swivel_chair", "score": 0.5, "bbox": [-10, 0, 50, 500]}, )"
          R"({"class": "chair", "score": 0.1, "bbox": [0, 0, 9, 9]}, )"
          R"({"class": "couch", "score": 0.7, "bbox": [1, 2, 30, 40]}, )"
          R"({"class": "unicorn", "score": 0.9, "bbox": [1, 2, 30, 40]}]})"
          "\n\n{\"timestamp\": \"6.5\", \"boxes\": []}\n"));
  const auto found = detector_.detect(frameAt(5.0));
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 2u);
  EXPECT_EQ((*found)[0].class_name, "sofa");
  EXPECT_EQ((*found)[1].class_name, "swivel_chair");
  EXPECT_EQ((*found)[1].box, (Box2{0, 0, 50, 480}));
  const auto empty = detector_.detect(frameAt(6.5));
  ASSERT_TRUE(empty);
  EXPECT_TRUE(empty->empty());
}

TEST_F(RecordedDetectorTest, JsonLinesSayWhatWasNotLookedFor) {
  prepare("file = " + write(R"({"timestamp": 5.0, "boxes": [{"class": "sofa", "score": 0.5, "bbox": [1, 2, 30, 40], "carried": true}, )"
                            R"({"class": "swivel_chair", "score": 0.5, "bbox": [1, 2, 30, 40]}], "unsought": ["sofa"]})"
                            "\n"));
  const auto found = detector_.detect(frameAt(5.0));
  ASSERT_EQ(found->size(), 1u) << "the sofa was carried here, and is again";
  EXPECT_EQ((*found)[0].class_name, "swivel_chair");
  EXPECT_EQ(detector_.unsought(), std::vector<std::string>{"sofa"});
}

TEST_F(RecordedDetectorTest, TextLinesOfCocoIndices) {
  prepare("file = " +
          write("# t id x y w h score\n5.0 39 1 1 5 5 0.9\n5.0 56 16 256 220 215 0.9\n6.0 57 0 0 9 9 0.8\n"));
  const auto found = detector_.detect(frameAt(5.0));
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 1u);  // the bottle (39) is no class of the database
  EXPECT_EQ((*found)[0].box, (Box2{16, 256, 236, 471}));
  EXPECT_EQ((*detector_.detect(frameAt(6.0)))[0].class_name, "sofa");
}

TEST_F(RecordedDetectorTest, BrokenFilesNameTheLine) {
  try {
    prepare("file = " + write("5.0 56 1 1 5 5 0.9\n5.0 chair 1 1 5 5\n"));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("boxes:2"));
  }
  EXPECT_THROW(prepare("file = " + write("5.0 56 1 1 -5 5 0.9\n")), InputError);
  EXPECT_THROW(prepare("file = " + write("5.0 56 1 1 1e300 5 0.9\n")), InputError);
  const std::string box = R"("boxes": [{"class": "chair", "score": 0.9, "bbox": [1, 1, 9, 9]}]})";
  EXPECT_NO_THROW(prepare("file = " + write(R"({"timestamp": "5.25", )" + box)));
  EXPECT_THROW(prepare("file = " + write(R"({"timestamp": "nan", )" + box)), InputError);
  EXPECT_THROW(prepare("file = " + write(R"({"timestamp": 1e999, )" + box)), InputError);
  EXPECT_THROW(prepare("file = " + (folder_ / "none").string()), InputError);
}

TEST_F(RecordedDetectorTest, BoxesOfALargerImageAreScaled) {
  prepare("");
  CObservationDetections large = record(1.0, "chair");
  large.image_width = 1280;
  large.image_height = 960;
  large.items.resize(1);
  large.items[0].u_min = 700, large.items[0].v_min = 500, large.items[0].u_max = 1200, large.items[0].v_max = 900;
  detector_.feed(large);
  const auto found = detector_.detect(frameAt(1.0));
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 1u);
  EXPECT_EQ((*found)[0].box, (Box2{350, 250, 600, 450}));
  large.timestamp = mrpt::Clock::fromDouble(2.0);
  large.image_height = 720;  // cut, not scaled
  detector_.feed(large);
  const auto refused = detector_.detect(frameAt(2.0));
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.reason(), HasSubstr("an image of 1280x720 px"));
}

TEST_F(RecordedDetectorTest, ImagesThatNoDetectorLookedAtAreNotAsked) {
  prepare("file = " + write(R"({"timestamp": 1, "boxes": []})" "\n" R"({"timestamp": 2, "boxes": [], "carried": true})" "\n"));
  EXPECT_TRUE(detector_.due(frameAt(1)));
  EXPECT_FALSE(detector_.due(frameAt(2)));
  EXPECT_TRUE(detector_.due(frameAt(3)));
}

// A run's own detections.jsonl, read again.
TEST_F(RecordedDetectorTest, WhatWasCarriedIsNoRecord) {
  const std::string box = R"({"class": "chair", "score": 0.9, "bbox": [1, 1, 9, 9]})";
  const std::string carried = R"({"class": "sofa", "score": 0.8, "bbox": [2, 2, 9, 9], "carried": true})";
  const auto records = readDetectionFile(write(R"({"timestamp": 1, "boxes": [)" + box + "]}\n" +
                                               R"({"timestamp": 2, "boxes": [)" + carried + "], \"carried\": true}\n" +
                                               R"({"timestamp": 3, "boxes": [], "carried": true})" + "\n" +
                                               R"({"timestamp": 4, "boxes": [)" + box + ", " + carried +
                                               "], \"unsought\": [\"sofa\"]}\n" + R"({"timestamp": 5, "boxes": []})" + "\n"));
  std::vector<double> times;
  for (const auto& [t, record] : records) times.push_back(t);
  EXPECT_EQ(times, (std::vector<double>{1, 2, 3, 4, 5}));
  EXPECT_TRUE(records.find(2)->second.carried && records.find(3)->second.carried);
  EXPECT_TRUE(records.find(2)->second.boxes.empty());
  EXPECT_FALSE(records.find(4)->second.carried || records.find(5)->second.carried);
  EXPECT_EQ(records.find(4)->second.boxes.size(), 1u);
}

TEST_F(RecordedDetectorTest, MasksGiveTheBoxAndAreCutToIt) {
  cv::Mat mask(480, 640, CV_8UC1, cv::Scalar(0));
  cv::rectangle(mask, {100, 50, 40, 60}, cv::Scalar(255), cv::FILLED);
  mask.at<uchar>(55, 105) = 0;  // a hole
  cv::imwrite((folder_ / "mask.png").string(), mask);
  const auto file = write(
      R"({"timestamp": "5.0", "boxes": [{"class": "chair", "score": 0.9, "track": 7, "mask": "mask.png"}]})");
  prepare("file = " + file);
  const auto found = detector_.detect(frameAt(5.0));
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 1u);
  EXPECT_EQ((*found)[0].box, (Box2{100, 50, 140, 110}));
  EXPECT_EQ((*found)[0].track.value, 7);
  ASSERT_EQ((*found)[0].mask.size(), cv::Size(40, 60));
  EXPECT_EQ((*found)[0].mask.at<uchar>(5, 5), 0);
  EXPECT_NE((*found)[0].mask.at<uchar>(0, 0), 0);

  const auto bad =
      write(R"({"timestamp": 5.0, "boxes": [{"class": "chair", "score": 0.9, "mask": "none.png"}]})");
  EXPECT_THAT([&] { readDetectionFile(bad); }, ::testing::ThrowsMessage<InputError>(HasSubstr("none.png")));
}

}  // namespace
}  // namespace roomgraph
