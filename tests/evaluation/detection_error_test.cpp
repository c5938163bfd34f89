// SPDX-License-Identifier: BSD-3-Clause
// Precision, recall and average precision against values worked out by hand.
#include "roomgraph/evaluation/detection_error.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace roomgraph {
namespace {

// Boxes of 50 x 100 px whose left side is at u: two of them 50 px apart have nothing in common.
Box2 boxAt(double u, double width = 50, double height = 100) {
  return {u, 10, u + width, 10 + height};
}
TrueBox truth(int id, const std::string& name, const Box2& box, double visible = 1) {
  return {id, name, name, box, visible};
}
DetectedBox found(const std::string& name, double score, const Box2& box) {
  return {name, score, box};
}

TEST(DetectionError, PerfectDetector) {
  const std::vector<TrueFrame> frames = {{1, {truth(1, "sofa", boxAt(0)), truth(2, "door", boxAt(100))}},
                                         {2, {truth(1, "sofa", boxAt(9))}}};
  const auto errors =
      evaluateDetections(frames, {{1, {found("sofa", 0.9, boxAt(0)), found("door", 0.3, boxAt(100))}},
                                  {2, {found("sofa", 0.8, boxAt(9))}}});
  EXPECT_EQ(errors.all.correct, 3);
  EXPECT_EQ(errors.all.precision, 1);
  EXPECT_EQ(errors.all.recall, 1);
  EXPECT_EQ(errors.all.f1, 1);
  EXPECT_DOUBLE_EQ(errors.all.ap, 1);
  EXPECT_EQ(errors.mean_precision, 1);
  EXPECT_EQ(errors.per_class.at("sofa").correct, 2);
}

TEST(DetectionError, HandComputedAveragePrecision) {
  // By score: hit (1/1 at recall 1/4), miss, hit (2/3 at 2/4), miss, miss, hit (3/6 at 3/4); one never found.
  const std::vector<TrueFrame> frames = {{1, {truth(1, "sofa", boxAt(0)), truth(2, "sofa", boxAt(100))}},
                                         {2, {truth(1, "sofa", boxAt(0)), truth(2, "sofa", boxAt(100))}}};
  const std::vector<DetectedFrame> detections = {
      {1, {found("sofa", 0.9, boxAt(0)), found("sofa", 0.8, boxAt(300)), found("sofa", 0.7, boxAt(100))}},
      {2, {found("sofa", 0.6, boxAt(300)), found("sofa", 0.5, boxAt(400)), found("sofa", 0.4, boxAt(0))}}};
  const auto errors = evaluateDetections(frames, detections);
  const auto& sofa = errors.per_class.at("sofa");
  EXPECT_EQ(sofa.correct, 3);
  EXPECT_EQ(sofa.false_alarms, 3);
  EXPECT_EQ(sofa.missed, 1);
  EXPECT_DOUBLE_EQ(sofa.precision, 0.5);
  EXPECT_DOUBLE_EQ(sofa.recall, 0.75);
  EXPECT_DOUBLE_EQ(sofa.f1, 0.6);
  EXPECT_NEAR(sofa.ap, (1.0 + 2.0 / 3 + 0.5) / 4, 1e-12);
  DetectionOptions sure;
  sure.min_score = 0.65;
  EXPECT_NEAR(evaluateDetections(frames, detections, sure).per_class.at("sofa").precision, 2.0 / 3, 1e-12);
}

TEST(DetectionError, EnvelopeUsesTheBestPrecisionStillToCome) {
  // Miss, hit, hit: precisions 0, 1/2, 2/3; both recall steps get 2/3.
  const std::vector<TrueFrame> frames = {{1, {truth(1, "sofa", boxAt(0)), truth(2, "sofa", boxAt(100))}}};
  const auto errors = evaluateDetections(
      frames,
      {{1, {found("sofa", 0.9, boxAt(300)), found("sofa", 0.8, boxAt(0)), found("sofa", 0.7, boxAt(100))}}});
  EXPECT_NEAR(errors.per_class.at("sofa").ap, 2.0 / 3, 1e-12);
}

TEST(DetectionError, SecondDetectionOfTheSameObjectIsAFalseAlarm) {
  const std::vector<TrueFrame> frames = {{1, {truth(1, "sofa", boxAt(0))}}};
  const auto errors =
      evaluateDetections(frames, {{1, {found("sofa", 0.6, boxAt(0)), found("sofa", 0.9, boxAt(5))}}});
  EXPECT_EQ(errors.all.correct, 1);
  EXPECT_EQ(errors.all.false_alarms, 1);
  EXPECT_DOUBLE_EQ(errors.all.ap, 1) << "the surer one, although it fits less well, comes first";
}

TEST(DetectionError, OverlapDecides) {
  // A shift by a third of the width: IoU = (2/3) / (4/3) = .5 exactly.
  const std::vector<TrueFrame> frames = {{1, {truth(1, "sofa", boxAt(0, 60))}}};
  const std::vector<DetectedFrame> detections = {{1, {found("sofa", 1, boxAt(20, 60))}}};
  EXPECT_EQ(evaluateDetections(frames, detections).all.correct, 1);
  DetectionOptions strict;
  strict.min_iou = 0.51;
  EXPECT_EQ(evaluateDetections(frames, detections, strict).all.correct, 0);
  EXPECT_EQ(evaluateDetections(frames, detections, strict).all.false_alarms, 1);
}

TEST(DetectionError, RegionsToIgnoreCountNeitherWay) {
  TrueBox stool = truth(4, "other", boxAt(300));
  stool.kind = "wooden chair";
  TrueBox bin = truth(5, "other", boxAt(400));
  bin.kind = "bin";
  const std::vector<TrueFrame> frames = {
      {1,
       {truth(1, "swivel_chair", boxAt(0), 0.5), truth(2, "swivel_chair", boxAt(100, 50, 40)),
        truth(3, "swivel_chair", boxAt(200), 0.51), stool, bin}}};
  const std::vector<DetectedFrame> on_all = {
      {1,
       {found("swivel_chair", 0.9, boxAt(0)), found("swivel_chair", 0.9, boxAt(100, 50, 40)),
        found("swivel_chair", 0.9, boxAt(200)), found("swivel_chair", 0.9, boxAt(300)),
        found("swivel_chair", 0.9, boxAt(400)), found("sofa", 0.9, boxAt(300))}}};
  const auto errors = evaluateDetections(frames, on_all);
  const auto& chair = errors.per_class.at("swivel_chair");
  EXPECT_EQ(chair.correct, 1);
  EXPECT_EQ(chair.ignored, 3);
  EXPECT_EQ(chair.false_alarms, 1) << "a bin is not a chair";
  EXPECT_EQ(chair.missed, 0);
  EXPECT_EQ(errors.per_class.at("sofa").false_alarms, 1) << "a wooden chair is no sofa";
  EXPECT_EQ(errors.per_class.count("other"), 0u);
  const auto nothing_found = evaluateDetections(frames, {{1, {}}});
  EXPECT_EQ(nothing_found.per_class.at("swivel_chair").missed, 1);
  DetectionOptions lenient;
  lenient.min_visible = 0.4;
  lenient.min_height_px = 39;
  EXPECT_EQ(evaluateDetections(frames, on_all, lenient).per_class.at("swivel_chair").correct, 3);
}

TEST(DetectionError, AllWrongAndWrongClass) {
  const std::vector<TrueFrame> frames = {{1, {truth(1, "sofa", boxAt(0))}}};
  const auto errors =
      evaluateDetections(frames, {{1, {found("door", 0.9, boxAt(0)), found("sofa", 0.9, boxAt(200))}}});
  EXPECT_EQ(errors.all.correct, 0);
  EXPECT_EQ(errors.all.false_alarms, 2);
  EXPECT_EQ(errors.all.missed, 1);
  EXPECT_EQ(errors.all.precision, 0);
  EXPECT_EQ(errors.all.recall, 0);
  EXPECT_EQ(errors.all.ap, 0);
}

TEST(DetectionError, EmptySides) {
  const std::vector<TrueFrame> frames = {{1, {truth(1, "sofa", boxAt(0))}}, {2, {}}};
  const auto silent = evaluateDetections(frames, {});
  EXPECT_EQ(silent.frames, 0);
  EXPECT_EQ(silent.frames_without_detector, 2);
  EXPECT_EQ(silent.all.missed, 0) << "frames the detector did not look at are left out";
  const auto elsewhere = evaluateDetections(frames, {{9, {found("sofa", 1, boxAt(0))}}});
  EXPECT_EQ(elsewhere.frames_without_truth, 1);
  EXPECT_EQ(elsewhere.all.false_alarms, 0);
  const auto no_objects = evaluateDetections(frames, {{2, {found("sofa", 1, boxAt(0))}}});
  EXPECT_EQ(no_objects.frames, 1);
  EXPECT_EQ(no_objects.all.false_alarms, 1);
  EXPECT_EQ(no_objects.all.ap, 0);
  EXPECT_EQ(evaluateDetections({}, {}).frames, 0);
}

TEST(DetectionError, OrderOfBoxesAndFramesDoesNotMatter) {
  std::vector<TrueFrame> frames;
  std::vector<DetectedFrame> detections;
  for (int i = 0; i < 4; ++i) {
    const double t = 1 + 0.1 * i;
    frames.push_back(
        {t, {truth(1, "sofa", boxAt(0)), truth(2, "sofa", boxAt(30)), truth(3, "door", boxAt(200))}});
    detections.push_back({t,
                          {found("sofa", 0.5, boxAt(10)), found("sofa", 0.5, boxAt(22)),
                           found("sofa", 0.1 * i, boxAt(300)), found("door", 0.7, boxAt(200 + 20 * i))}});
  }
  const auto before = evaluateDetections(frames, detections);
  std::reverse(frames.begin(), frames.end());
  std::rotate(detections.begin(), detections.begin() + 1, detections.end());
  for (auto& frame : detections) std::reverse(frame.boxes.begin(), frame.boxes.end());
  const auto after = evaluateDetections(frames, detections);
  for (const auto* name : {"sofa", "door"}) {
    EXPECT_EQ(before.per_class.at(name).correct, after.per_class.at(name).correct);
    EXPECT_EQ(before.per_class.at(name).false_alarms, after.per_class.at(name).false_alarms);
    EXPECT_DOUBLE_EQ(before.per_class.at(name).ap, after.per_class.at(name).ap);
  }
  EXPECT_GT(before.all.false_alarms, 0);
}

TEST(DetectionError, MeansAreOverTheClassesConcerned) {
  const std::vector<TrueFrame> frames = {{1, {truth(1, "sofa", boxAt(0)), truth(2, "door", boxAt(100))}}};
  const auto errors =
      evaluateDetections(frames, {{1, {found("sofa", 1, boxAt(0)), found("person", 1, boxAt(200))}}});
  EXPECT_DOUBLE_EQ(errors.all.ap, 0.5) << "sofa 1, door 0; there is no person";
  EXPECT_DOUBLE_EQ(errors.mean_recall, 0.5);
  EXPECT_DOUBLE_EQ(errors.mean_precision, 0.5) << "sofa 1, person 0; no door was reported";
}

}  // namespace
}  // namespace roomgraph
