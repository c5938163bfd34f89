// SPDX-License-Identifier: BSD-3-Clause
// Scores as probabilities, and what several networks say of one thing.
#include "score_calibration.h"

#include <gmock/gmock.h>

#include "errors_of.h"
#include "roomgraph/core/errors.h"
#include "suppress.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

RawBox raw(double u, double score, int kind, int network) {
  return {{u, 10, u + 100, 110}, kind, score, {}, network};
}

class ScoreCalibrationFile : public ::testing::Test {
 protected:
  ScoreCalibration with(const std::string& text) const {
    folder_.write("net.scores.json", text);
    return ScoreCalibration::beside((folder_.path() / "net.onnx").string());
  }
  const test::TemporaryFolder folder_;
};

TEST_F(ScoreCalibrationFile, StretchesAndShiftsLogits) {
  const auto scores = with(R"({"made_of": "anything", "classes": {"door": {"slope": 2, "shift": -1}}})");
  // By hand: logit(.8) = ln 4; the odds are 4^2 / e.
  EXPECT_NEAR(scores.probability("door", 0.8), 16 / std::exp(1) / (1 + 16 / std::exp(1)), 1e-12);
  EXPECT_EQ(scores.probability("sofa", 0.8), 0.8);
  EXPECT_GT(scores.probability("door", 1), 0.999);
  EXPECT_LT(scores.probability("door", 0), 0.001);
}

TEST_F(ScoreCalibrationFile, NothingIsLostBelowTheLeastScore) {
  const auto scores = with(R"({"classes": {"door": {"slope": 2, "shift": 1}, "sofa": {"slope": 3, "shift": -2}}})");
  const double least = scores.leastScore(0.35);
  EXPECT_NEAR(scores.probability("door", least), 0.35, 1e-12) << "the class whose scores rise most";
  EXPECT_LE(scores.probability("sofa", least), 0.35);
  EXPECT_EQ(ScoreCalibration().leastScore(0.35), 0.35);
}

TEST_F(ScoreCalibrationFile, MayBeMissingButNotBroken) {
  EXPECT_EQ(ScoreCalibration::beside("/nowhere/net.onnx").probability("door", 0.3), 0.3);
  for (const std::string text : {"{", "{}", R"({"classes": {"door": {"slope": 0, "shift": 0}}})", R"({"classes": {"door": {"slope": 1}}})",
                                 R"({"classes": {"door": {"slope": 1, "shift": 1e9}}})", R"({"classes": [1]})"})
    EXPECT_THAT(test::messageOf<InputError>([&] { with(text); }), HasSubstr("net.scores.json")) << text;
  EXPECT_THAT(test::messageOf<InputError>([&] { with(R"({"classes": {"door": {"slope": -1, "shift": 0}}})"); }),
              AllOf(HasSubstr("class door"), HasSubstr("slope")));
}

TEST(FuseNetworks, OneThingOfTwoNetworksIsTheMeanOfItsBoxes) {
  std::vector<RawBox> boxes{raw(0, 0.5, 0, 0), raw(30, 0.25, 0, 1), raw(30, 0.4, 1, 1), raw(300, 0.3, 0, 1)};
  const auto kept = fuseNetworks(boxes, {0, 2, 3, 1}, 0.5);
  EXPECT_THAT(kept, ElementsAre(0, 2, 3));
  EXPECT_NEAR(boxes[0].box.u_min, 10, 1e-12) << "a third of the way, as its score is a third of the sum";
  EXPECT_NEAR(boxes[0].box.u_max, 110, 1e-12);
  EXPECT_NEAR(boxes[0].score, 1 - 0.5 * 0.75, 1e-12);
  EXPECT_EQ(boxes[2].box, raw(30, 0, 1, 1).box) << "of another class";
  EXPECT_EQ(boxes[3].score, 0.3) << "elsewhere";
}

TEST(FuseNetworks, BoxesOfOneNetworkStayApart) {
  std::vector<RawBox> boxes{raw(0, 0.5, 0, 0), raw(10, 0.4, 0, 0)};
  EXPECT_THAT(fuseNetworks(boxes, {0, 1}, 0.5), ElementsAre(0, 1));
  EXPECT_EQ(boxes[0].score, 0.5);
}

TEST(FuseNetworks, ASecondPartOfAThingIsNoThing) {
  // The second network splits what the first one found.
  std::vector<RawBox> boxes{raw(0, 0.9, 0, 0), raw(20, 0.6, 0, 1), raw(-30, 0.5, 0, 1)};
  EXPECT_THAT(fuseNetworks(boxes, {0, 1, 2}, 0.5), ElementsAre(0));
  EXPECT_NEAR(boxes[0].score, 1 - 0.1 * 0.4, 1e-12);
}

TEST(FuseNetworks, WhatTwoSayMayOvertakeWhatOneSays) {
  std::vector<RawBox> boxes{raw(0, 0.6, 0, 0), raw(300, 0.5, 0, 0), raw(300, 0.4, 0, 1)};
  EXPECT_THAT(fuseNetworks(boxes, {0, 1, 2}, 0.5), ElementsAre(1, 0));
}

TEST(FuseNetworks, AMaskKeepsItsSides) {
  std::vector<RawBox> boxes{raw(0, 0.5, 0, 0), raw(30, 0.25, 0, 1)};
  boxes[1].mask = cv::Mat::ones(4, 4, CV_8UC1);
  fuseNetworks(boxes, {0, 1}, 0.5);
  EXPECT_EQ(boxes[0].box, raw(30, 0, 0, 1).box);
  EXPECT_FALSE(boxes[0].mask.empty());
  EXPECT_NEAR(boxes[0].score, 1 - 0.5 * 0.75, 1e-12);
}

}  // namespace
}  // namespace roomgraph
