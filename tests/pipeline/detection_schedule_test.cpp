// SPDX-License-Identifier: BSD-3-Clause
// DetectionSchedule: on which frames the detector runs, and until when its boxes are carried.
#include "detection_schedule.h"

#include <gmock/gmock.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace roomgraph {
namespace {

using ::testing::ElementsAre;

const ObjectDatabase& classes() {
  static const ObjectDatabase db =
      ObjectDatabase::fromText("[swivel_chair]\nlabels = chair\n[person]\nlabels = person\nlandmark = false\n");
  return db;
}

/// Noise of fixed seed that nothing moves in: corners everywhere.
Frame still(int index) {
  Frame frame;
  frame.id = FrameId{index};
  frame.t = 10 + 0.1 * index;
  frame.camera = {320, 240, 260, 260, 159.5, 119.5, {}};
  frame.gray = cv::Mat(240, 320, CV_8UC1);
  cv::RNG(5).fill(frame.gray, cv::RNG::UNIFORM, 0, 256);
  cv::GaussianBlur(frame.gray, frame.gray, {}, 1.5);
  return frame;
}

std::vector<Detection> chairAndPerson() {
  return {{{60, 60, 140, 180}, "swivel_chair", "chair", 0.8, {}, {}},
          {{180, 40, 260, 220}, "person", "person", 0.6, {}, {}}};
}

DetectionSchedule schedule(int every_nth_frame, int max_carried_frames = 5, bool track_boxes = true) {
  DetectionStageOptions options;
  options.every_nth_frame = every_nth_frame;
  options.max_carried_frames = max_carried_frames;
  options.track_boxes = track_boxes;
  return {options, classes()};
}

/// Sources of the boxes of `frames` frames; the detector fails on those in `failing`.
// Where the boxes of a frame come from.
enum BoxSource { kNone, kDetected, kCarried };

BoxSource sourceOf(const FrameDetections& detections) {
  EXPECT_FALSE(detections.fresh && detections.carried);
  if (detections.fresh) return kDetected;
  return detections.carried ? kCarried : kNone;
}

std::vector<BoxSource> sourcesOf(DetectionSchedule schedule, int frames, const std::vector<int>& failing = {}) {
  std::vector<BoxSource> sources;
  for (int i = 0; i < frames; ++i) {
    const bool fails = std::find(failing.begin(), failing.end(), i) != failing.end();
    sources.push_back(sourceOf(schedule.due(still(i).t) && !fails ? schedule.detected(chairAndPerson(), still(i))
                                                        : schedule.missed(still(i), {})));
  }
  return sources;
}

TEST(DetectionSchedule, EveryFrameOrEveryNth) {
  EXPECT_THAT(sourcesOf(schedule(1), 3), ElementsAre(kDetected, kDetected, kDetected));
  EXPECT_THAT(sourcesOf(schedule(3), 7),
              ElementsAre(kDetected, kCarried, kCarried, kDetected, kCarried, kCarried, kDetected));
}

TEST(DetectionSchedule, SoManyFramesASecondWhateverTheCamerasRate) {
  // Frames come at 10 Hz.
  const auto detectedAt = [](double rate_hz, int frames) {
    DetectionStageOptions options;
    options.rate_hz = rate_hz;
    const auto sources = sourcesOf(DetectionSchedule(options, classes()), frames);
    std::vector<int> out;
    for (int i = 0; i < frames; ++i)
      if (sources[static_cast<std::size_t>(i)] == kDetected) out.push_back(i);
    return out;
  };
  EXPECT_THAT(detectedAt(4, 21), ElementsAre(0, 3, 5, 8, 10, 13, 15, 18, 20)) << "4 Hz in the mean";
  EXPECT_EQ(detectedAt(10, 20).size(), 20u) << "the camera's own rate";
  EXPECT_EQ(detectedAt(30, 20).size(), 20u) << "more than there are";
  EXPECT_THAT(detectedAt(1, 21), ElementsAre(0, 10, 20));
}

TEST(DetectionSchedule, AfterAFailureTheDetectorIsAskedAgainAtOnce) {
  EXPECT_THAT(sourcesOf(schedule(3), 8, {3, 4}),
              ElementsAre(kDetected, kCarried, kCarried, kCarried, kCarried, kDetected, kCarried, kCarried));
  EXPECT_THAT(sourcesOf(schedule(2), 4, {0}), ElementsAre(kNone, kDetected, kCarried, kDetected))
      << "nothing to carry before the first detection";
}

TEST(DetectionSchedule, BoxesAreCarriedSoManyFramesAndNoFurther) {
  DetectionSchedule boxes = schedule(9, 2);
  EXPECT_FALSE(boxes.carriedFrom());
  EXPECT_EQ(boxes.detected(chairAndPerson(), still(0)).age, 0);
  EXPECT_EQ(boxes.carriedFrom(), 10.0);
  for (int i = 1; i <= 2; ++i) {
    const FrameDetections carried = boxes.missed(still(i), Pose3::Identity());
    EXPECT_EQ(sourceOf(carried), kCarried);
    EXPECT_EQ(carried.age, i);
    ASSERT_EQ(carried.boxes.size(), 2u);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_TRUE(carried.boxes[k].carried);
      EXPECT_EQ(carried.boxes[k].class_name, chairAndPerson()[k].class_name);
      EXPECT_GT(iou(carried.boxes[k].box, chairAndPerson()[k].box), 0.98) << "nothing moved";
    }
    EXPECT_EQ(boxes.carriedFrom(), still(i).t);
  }
  const FrameDetections after = boxes.missed(still(3), Pose3::Identity());
  EXPECT_EQ(sourceOf(after), kNone);
  EXPECT_TRUE(after.boxes.empty()) << "no box, of a person neither, outlives its carrying";
  EXPECT_EQ(after.age, 3);
  EXPECT_FALSE(boxes.carriedFrom());
  EXPECT_EQ(sourceOf(boxes.missed(still(4), {})), kNone);
}

TEST(DetectionSchedule, WithoutTrackingTheFramesBetweenHaveNoBoxes) {
  const auto none_between = ElementsAre(kDetected, kNone, kNone, kDetected);
  EXPECT_THAT(sourcesOf(schedule(3, 5, false), 4), none_between);
  EXPECT_THAT(sourcesOf(schedule(3, 0), 4), none_between);
}

TEST(DetectionSchedule, ThatThereIsNothingIsCarriedToo) {
  DetectionSchedule boxes = schedule(2);
  boxes.detected({}, still(0));
  const FrameDetections carried = boxes.missed(still(1), {});
  EXPECT_EQ(sourceOf(carried), kCarried);
  EXPECT_TRUE(carried.boxes.empty());
}

TEST(DetectionSchedule, AnImageThatCannotBeTrackedEndsTheBoxes) {
  DetectionSchedule boxes = schedule(4);
  boxes.detected(chairAndPerson(), still(0));
  Frame blind = still(1);
  blind.gray.release();
  EXPECT_EQ(sourceOf(boxes.missed(blind, {})), kNone);
  EXPECT_EQ(sourceOf(boxes.missed(still(2), {})), kNone) << "there is nothing to carry any more";
  EXPECT_FALSE(boxes.due(still(3).t));
  boxes.missed(still(3), {});
  EXPECT_TRUE(boxes.due(still(4).t));
}

// A network for chairs that runs on every third frame beside one for people that runs on all: the chair is carried between, until
// it is too old.
TEST(DetectionSchedule, BoxesOfClassesThatWereNotLookedForAreCarried) {
  DetectionSchedule boxes = schedule(1, 2);
  boxes.detected(chairAndPerson(), still(0));
  const std::vector<Detection> person{chairAndPerson()[1]};
  for (int i = 1; i <= 2; ++i) {
    const auto found = boxes.detected(person, still(i), {"swivel_chair"}, Pose3::Identity());
    EXPECT_EQ(sourceOf(found), kDetected);
    EXPECT_EQ(found.age, 0);
    EXPECT_THAT(found.unsought, ElementsAre("swivel_chair"));
    ASSERT_EQ(found.boxes.size(), 2u) << "frame " << i;
    EXPECT_EQ(found.boxes[0].class_name, "swivel_chair") << "the better score comes first";
    EXPECT_TRUE(found.boxes[0].carried);
    EXPECT_GT(iou(found.boxes[0].box, chairAndPerson()[0].box), 0.98);
    EXPECT_FALSE(found.boxes[1].carried);
  }
  EXPECT_EQ(boxes.detected(person, still(3), {"swivel_chair"}, Pose3::Identity()).boxes.size(), 1u) << "too old";
  EXPECT_EQ(boxes.detected(chairAndPerson(), still(4)).boxes.size(), 2u);
  EXPECT_EQ(boxes.detected({}, still(5)).boxes.size(), 0u) << "looked for, and not there";
}

TEST(DetectionSchedule, FramesWithoutTheDetectorCountForClassesThatItDidNotLookFor) {
  DetectionSchedule boxes = schedule(2, 3);
  boxes.detected(chairAndPerson(), still(0));
  boxes.missed(still(1), Pose3::Identity());
  EXPECT_EQ(boxes.detected({}, still(2), {"swivel_chair"}, Pose3::Identity()).boxes.size(), 1u);
  EXPECT_EQ(boxes.missed(still(3), Pose3::Identity()).boxes.size(), 1u) << "three frames old";
  EXPECT_EQ(boxes.detected({}, still(4), {"swivel_chair"}, Pose3::Identity()).boxes.size(), 0u) << "four frames old";
}

}  // namespace
}  // namespace roomgraph
