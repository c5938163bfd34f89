// SPDX-License-Identifier: BSD-3-Clause
// Words about an object and about a moment: every number that is known is told, worked out by hand.
#include "roomgraph/viewer/descriptions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "made_up_states.h"

namespace roomgraph::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

ShownLandmark sofa() {
  Landmark landmark = sampleLandmark(12, "sofa", ShapeKind::kCuboid, 1.5, -0.25);
  landmark.shape = {ShapeKind::kCuboid, 1.9, 0.8, 0.75};
  landmark.covariance = Eigen::Vector4d(0.04, 0.09, 0.0001, std::pow(0.1745329252, 2)).asDiagonal();
  landmark.yaw = M_PI / 2;
  landmark.class_posterior = {{"armchair", 0.25}, {"sofa", 0.747}, {"bench", 0.003}};
  return {landmark, true, {}};
}

const TextBlock& blockOf(const std::vector<TextBlock>& blocks, const std::string& heading) {
  for (const auto& block : blocks)
    if (block.heading == heading) return block;
  ADD_FAILURE() << "no " << heading;
  static const TextBlock kNone;
  return kNone;
}

TEST(Descriptions, OfAnObjectWhatItIsAndWhere) {
  const auto blocks = describeLandmark(sofa(), {}, kBegin_t);
  EXPECT_THAT(blockOf(blocks, "sofa 12").lines, ElementsAre("existence 0.930, in the map"));
  EXPECT_THAT(blockOf(blocks, "Class").lines, ElementsAre(" 75 %  sofa", " 25 %  armchair"));
  EXPECT_THAT(blockOf(blocks, "Size and place").lines,
              ElementsAre("width 1.90 m, depth 0.80 m, height 0.75 m",
                          "x 1.50 ± 0.20 m, y -0.25 ± 0.30 m, z 0.01 m", "front towards 90 ± 10°"));
  EXPECT_THAT(blockOf(blocks, "Sightings").lines, ElementsAre("none known"));
  EXPECT_EQ(blocks.size(), 4u) << "neither sightings nor evidence are known";
}

TEST(Descriptions, OfARoundThingNoFrontAndOfACandidateThatItIsNone) {
  ShownLandmark round{sampleLandmark(3, "swivel_chair", ShapeKind::kCylinder, 0, 0), false, {}};
  round.landmark.covariance(0, 0) = -1e-9;
  const auto blocks = describeLandmark(round, {}, kBegin_t);
  EXPECT_THAT(blockOf(blocks, "swivel chair 3").lines.front(), HasSubstr("not in the map"));
  EXPECT_EQ(blockOf(blocks, "Size and place").lines.size(), 2u);
  EXPECT_THAT(blockOf(blocks, "Size and place").lines[1], HasSubstr("x 0.00 ± 0.00 m"));
}

TEST(Descriptions, OfItsSightingsHowSureTheyWere) {
  const std::vector sightings{sightingAt(12, 2, 0.8), sightingAt(12, 3.5, 0.96), sightingAt(12, 10, 1)};
  const auto lines = blockOf(describeLandmark(sofa(), sightings, kBegin_t), "Sightings").lines;
  EXPECT_THAT(lines,
              ElementsAre("3, from 2.0 s to 10.0 s", "association: mean p 0.920, least 0.800, 1 below 0.9"));
}

TEST(Descriptions, OfTheLastSightingWhyItWasTakenForThisOne) {
  ShownSighting last = sightingAt(12, 10);
  last.posterior = {
      {LandmarkId{4}, 0.02}, {LandmarkId{}, 0.05}, {LandmarkId{12}, 0.9}, {LandmarkId{7}, 0.03}};
  auto lines = blockOf(describeLandmark(sofa(), {sightingAt(12, 2), last}, kBegin_t), "Last sighting").lines;
  EXPECT_THAT(lines, ElementsAre("at 10.0 s, shape from depth, score 0.60",
                                 "p(landmark): #12 0.900, new 0.050, #7 0.030",
                                 "energy: unary 1.25, pairwise -0.50, high order 0.12", "p(selected) 0.800"));
  last.made_new = true;
  last.source.clear();
  lines = blockOf(describeLandmark(sofa(), {last}, kBegin_t), "Last sighting").lines;
  EXPECT_THAT(lines.front(), HasSubstr("shape from ?"));
  EXPECT_THAT(lines.back(), HasSubstr("it made the landmark"));
}

TEST(Descriptions, OfTheEvidenceWhatSaysMost) {
  ShownLandmark shown = sofa();
  shown.evidence = {{"filter", 4},  {"crossed", -0.5}, {"label", 0.9}, {"turned", 0},  {"score", 0.6},
                    {"spread", .2}, {"size", -2.5},    {"filled", .1}, {"scatter", .3}};
  EXPECT_THAT(blockOf(describeLandmark(shown, {}, kBegin_t), "Evidence of existence").lines,
              ElementsAre("+4.00  filter", "-2.50  size", "+0.90  label", "+0.60  score", "-0.50  crossed",
                          "+0.30  scatter"));
}

TEST(Descriptions, SightingsOverTimeAreSharesOfTheMost) {
  const std::vector sightings{sightingAt(1, 0),   sightingAt(1, 1),  sightingAt(1, 4.9), sightingAt(1, 5),
                              sightingAt(1, 9.9), sightingAt(1, 10), sightingAt(1, 99),  sightingAt(1, -3)};
  const auto shares = sightingsOverTime(sightings, kBegin_t, kBegin_t + 10, 4);
  EXPECT_THAT(shares, ElementsAre(1, testing::FloatEq(1 / 3.f), testing::FloatEq(1 / 3.f), 1));
  EXPECT_THAT(sightingsOverTime({}, kBegin_t, kBegin_t + 10, 3), ElementsAre(0, 0, 0));
  EXPECT_THAT(sightingsOverTime({sightingAt(1, 0)}, kBegin_t, kBegin_t, 2), ElementsAre(1, 0))
      << "a run of one moment";
}

TEST(Descriptions, OfAMomentWhatIsInTheMap) {
  auto state = stateAt(12);
  EXPECT_EQ(describeMoment(*state, kBegin_t), "record 12, 12.0 s: 0 objects");
  const Landmark landmark = sampleLandmark(1, "sofa", ShapeKind::kCuboid, 0, 0);
  state->landmarks = std::make_shared<const ShownLandmarks>(ShownLandmarks{
      shownLandmark(landmark), shownLandmark(landmark, false), shownLandmark(landmark, false)});
  state->key_poses = std::make_shared<const ShownPath>(5);
  const double t = state->t;
  state->closures = std::make_shared<const std::vector<ShownClosure>>(
      std::vector<ShownClosure>{{t - 9, t}, {t + 3, t - 8}, {t - 7, t + 1}});  // two of what comes later
  state->note = "not tracked: too dark";
  EXPECT_EQ(describeMoment(*state, kBegin_t + 2),
            "record 12, 10.0 s: 1 object (2 candidates), 5 key poses, 1 loop closure; not tracked: too dark");
  // A long run, in which an edge stands for many closures.
  state->note.clear();
  state->loop_closures = 80;
  EXPECT_EQ(describeMoment(*state, kBegin_t + 2), "record 12, 10.0 s: 1 object (2 candidates), 5 key poses, 1 tie of loop closures");
  state->t += 5;
  EXPECT_EQ(describeMoment(*state, kBegin_t + 2), "record 12, 15.0 s: 1 object (2 candidates), 5 key poses, 3 ties of 80 loop closures");
}

TEST(Descriptions, OfAMapWithoutTime) {
  ViewState state;
  EXPECT_EQ(describeMoment(state, kBegin_t), "0 objects");
}

TEST(Descriptions, OfASpeed) {
  EXPECT_EQ(describeSpeed(1), "1×");
  EXPECT_EQ(describeSpeed(16), "16×");
  EXPECT_EQ(describeSpeed(0.25), "1/4×");
  EXPECT_EQ(describeSpeed(0), "max");
}

}  // namespace
}  // namespace roomgraph::test
