// SPDX-License-Identifier: BSD-3-Clause
// Evidence for existence: means over sightings by hand, contested boxes, places from which it was detected and missed.
#include <cmath>

#include "evidence_fixture.h"

namespace roomgraph::test {
namespace {

TEST_F(Evidence, OfSightingsByHand) {
  const Landmark chair = landmarkOf(4, "chair", 3, 0);
  frames_ = {frameWith(0, 0, {chair}), frameWith(1, 0.1, {chair}), frameWith(2, 0.2, {chair})};
  auto& far = frames_[1].decisions[0].seen;
  far.world_from_object.translation().x() = 3.4;
  far.covariance = 0.04 * Eigen::Matrix4d::Identity();
  far.measurement.proposal.score = 0.8;
  for (auto& frame : frames_) frame.decisions[0].seen.measurement.detection.score = 0.4;
  far.measurement.detection.score = 0.3;
  const ExistenceEvidence evidence = of({chair});
  EXPECT_NEAR(evidence.score, (0.5 * 0.5 + 0.8 * 0.8 + 0.5 * 0.5) / 1.8, 1e-12);
  EXPECT_NEAR(evidence.confidence, (0.5 * 0.4 + 0.8 * 0.3 + 0.5 * 0.4) / 1.8 / 0.4, 1e-6)
      << "of what is sure here";
  EXPECT_NEAR(evidence.sightings, std::log(1 + 0.8), 1e-12) << "one key pose: the largest weight";
  EXPECT_NEAR(evidence.directions, 0, 1e-12) << "one direction";
  EXPECT_NEAR(evidence.scatter, std::log(0.05 + 0.4 * 0.4 / 0.04 / 3), 1e-12);
  EXPECT_NEAR(evidence.filter, std::log(9.0), 1e-9);
  EXPECT_NEAR(evidence.label, 0.75, 1e-12);
  EXPECT_NEAR(evidence.size, 0, 1e-12);
}

TEST_F(Evidence, SightingsFromOtherKeyPosesAndDirectionsCount) {
  const Landmark chair = landmarkOf(4, "chair", 3, 0);
  poses_.add(10, poseFromYpr(3, -3, 0, M_PI / 2, 0, 0));
  frames_ = {frameWith(0, 0, {chair}), frameWith(1, 10, {chair})};
  const ExistenceEvidence evidence = of({chair});
  EXPECT_NEAR(evidence.sightings, std::log(1 + 0.5 + 0.5), 1e-12);
  EXPECT_NEAR(evidence.directions, std::log(2.0), 1e-12);
}

TEST_F(Evidence, SizeInStandardDeviations) {
  Landmark chair = landmarkOf(4, "chair", 3, 0);
  chair.shape.width += 0.2, chair.shape.depth += 0.1, chair.shape.height -= 0.2;
  EXPECT_NEAR(of({chair}).size, 3, 1e-9);
}

TEST_F(Evidence, ShorterThanItsClassBeyondTwoStandardDeviations) {
  Landmark sofa = landmarkOf(1, "sofa", 3, 0);
  EXPECT_EQ(of({sofa}).shorter, 0);
  sofa.shape.width = 1.55;
  EXPECT_NEAR(of({sofa}).shorter, 0.5, 1e-9);
  sofa.shape.width = 1.61;
  EXPECT_EQ(of({sofa}).shorter, 0);
  sofa.shape.width = 2.5, sofa.shape.depth = 0.3, sofa.shape.height = 0.3;
  EXPECT_EQ(of({sofa}).shorter, 0) << "the longer side alone";
}

// The class's widths vary by .1 m: information of 100 / m^2.
TEST_F(Evidence, LengthMeasuredAgainstTheClassBySightingsOfItsOwnYaw) {
  const Landmark sofa = landmarkOf(1, "sofa", 3, 0);
  frames_.assign(3, frameWith(0, 0, {sofa}));
  for (auto& frame : frames_) {
    auto& proposal = frame.decisions[0].seen.measurement.proposal;
    proposal.has_yaw = true;
    proposal.size_information = {60, 1000, 1000};
  }
  EXPECT_NEAR(of({sofa}).measured, 60.0 / 160, 1e-9) << "three from one direction say as much as one";
  frames_[1].decisions[0].seen.world_from_object = poseFromYpr(3, 0, 0, M_PI / 2, 0, 0);
  EXPECT_NEAR(of({sofa}).measured, 40.0 / 140, 1e-9) << "one took width for depth";
  frames_[2].decisions[0].seen.measurement.proposal.class_name = "chair";
  EXPECT_NEAR(of({sofa}).measured, 20.0 / 120, 1e-9) << "one is of another shape";
  poses_.add(10, poseFromYpr(3, -3, 0, M_PI / 2, 0, 0));
  frames_.push_back(frames_[0]);
  frames_.back().t = 10;
  EXPECT_NEAR(of({sofa}).measured, 80.0 / 180, 1e-9) << "another direction adds";
}

TEST_F(Evidence, YawsAcrossAreTurnedAndOppositeOnesAreNot) {
  const Landmark sofa = landmarkOf(1, "sofa", 3, 0);
  frames_.assign(4, frameWith(0, 0, {sofa}));
  const double yaws[] = {0.1, M_PI - 0.1, M_PI / 2, -1};
  for (std::size_t i = 0; i < 4; ++i) {
    auto& seen = frames_[i].decisions[0].seen;
    seen.measurement.proposal.has_yaw = true;
    seen.world_from_object = poseFromYpr(3, 0, 0, yaws[i], 0, 0);
  }
  EXPECT_NEAR(of({sofa}).turned, 0.5, 1e-12);
  frames_[0].decisions[0].seen.measurement.proposal.score = 1;
  EXPECT_NEAR(of({sofa}).turned, 1 / 2.5, 1e-12) << "weighted by score";
}

// One sighting .2 s after an image that shows the sofa well, one when no image did, laid across.
TEST_F(Evidence, SightingsInGoodViewSayHowItIsTurnedWhenThereAreAny) {
  const Landmark sofa = landmarkOf(1, "sofa", 3, 0);
  frames_ = {frameWith(0, 0.2, {sofa}), frameWith(1, 5, {sofa})};
  for (auto& frame : frames_) frame.decisions[0].seen.measurement.proposal.has_yaw = true;
  frames_[1].decisions[0].seen.world_from_object = poseFromYpr(3, 0, 0, M_PI / 2, 0, 0);
  EXPECT_NEAR(of({sofa}).turned, 0.5, 1e-12) << "without images all count";
  memory_.add(frameOfDepth(0, 0, 2.6F), Pose3::Identity());
  EXPECT_NEAR(of({sofa}).turned, 0, 1e-12);
  frames_.erase(frames_.begin());
  EXPECT_NEAR(of({sofa}).turned, 1, 1e-12) << "seen in no good view at all";
}

// A chair before another one covers its box; the boxes of the one behind are contested in frames that do not
// show the first beside it.
TEST_F(Evidence, BoxesThatAnUnseenLandmarkCoversAreContested) {
  const Landmark behind = landmarkOf(1, "chair", 3.6, 0);
  Landmark before = landmarkOf(2, "chair", 3, 0);
  frames_ = {frameWith(0, 0, {behind, before}), frameWith(1, 0.1, {behind}), frameWith(2, 0.2, {behind}),
             frameWith(3, 0.3, {behind})};
  EXPECT_NEAR(of({behind, before}).contested, 0.75, 1e-12);
  searched_ = {{0, {}}, {0.1, {"chair"}}, {0.2, {"door"}}, {0.3, {}}};
  EXPECT_NEAR(of({behind, before}).contested, 0.5, 1e-12) << "in one of them nobody looked for chairs";
  searched_.clear();
  before.observations = 9;
  EXPECT_NEAR(of({behind, before}).contested, 0, 1e-12) << "by a landmark that was seen less";
  before = landmarkOf(2, "chair", 3, 1);
  EXPECT_NEAR(of({behind, before}).contested, 0, 1e-12) << "by a landmark beside it";
}

TEST_F(Evidence, BoxesWithASurerLabelOfAnotherKindAreMislabelled) {
  const Landmark chair = landmarkOf(4, "chair", 3, 0);
  frames_.assign(4, frameWith(0, 0, {chair}));
  const double rivals[] = {0.7, 0.5, 0, 0.9};
  for (std::size_t i = 0; i < 4; ++i) {
    auto& detection = frames_[i].decisions[0].seen.measurement.detection;
    detection.score = 0.6;
    detection.rival_score = rivals[i];
  }
  EXPECT_NEAR(of({chair}).mislabelled, 0.5, 1e-12);
}

// A detector calls one thing a chair and a sofa: two boxes in one place.
TEST_F(Evidence, TheWorseOfTwoLabelsOfOneBoxIsOutdone) {
  const Landmark sofa = landmarkOf(1, "sofa", 3, 0), chair = landmarkOf(2, "chair", 3, 0);
  frames_.assign(4, frameWith(0, 0, {sofa, chair}));
  for (auto& frame : frames_) {
    frame.decisions[1].seen.measurement.detection.box = frame.decisions[0].seen.measurement.detection.box;
    frame.decisions[0].seen.measurement.proposal.score = 0.8;
  }
  EXPECT_NEAR(of({chair, sofa}).outdone, 1, 1e-12);
  EXPECT_NEAR(of({sofa, chair}).outdone, 0, 1e-12) << "it fits better";
  frames_[0].decisions[0].seen.measurement.proposal.score = 0.4;
  EXPECT_NEAR(of({chair, sofa}).outdone, 0.75, 1e-12) << "in one frame the chair fits better";
  EXPECT_NEAR(of({sofa, chair}).outdone, 0.4 / 2.8, 1e-12) << "weighted by score";
  Box2& box = frames_[1].decisions[1].seen.measurement.detection.box;
  box.u_min += box.width();
  box.u_max += box.width();
  EXPECT_NEAR(of({chair, sofa}).outdone, 0.5, 1e-12) << "in another one its box is elsewhere";
  frames_[2].decisions[0].seen.measurement.proposal.class_name = "chair";
  EXPECT_NEAR(of({chair, sofa}).outdone, 0.25, 1e-12) << "the same label twice is no other label";
}

// Seen from three places, with boxes at two of them, one .2 s after the image that is remembered.
TEST_F(Evidence, DetectedFromTwoOfThreePlaces) {
  const Landmark chair = landmarkOf(1, "chair", 3, 0), behind_the_wall = landmarkOf(2, "chair", 4.3, 0);
  for (const int place : {0, 1, 2}) {
    const Pose3 here = poseFromYpr(0.2 * place, 0, 0, 0, 0, 0);
    if (place > 0) poses_.add(10 * place, here);
    memory_.add(frameOfDepth(place, 10 * place, 3), here);
  }
  EXPECT_NEAR(of({chair}).detected, std::log(1.0 / 4), 1e-12);
  frames_ = {frameWith(0, 0, {chair}), frameWith(1, 10.2, {chair}), frameWith(2, 10.3, {chair})};
  EXPECT_NEAR(of({chair}).detected, std::log(3.0 / 2), 1e-12);
  searched_ = {{0, {}}, {10, {}}, {19.9, {"chair"}}, {20, {"chair"}}};
  EXPECT_NEAR(of({chair}).detected, std::log(3.0), 1e-12) << "at the third place nobody looked for chairs";
  searched_.push_back({20.2, {}});
  EXPECT_NEAR(of({chair}).detected, std::log(3.0 / 2), 1e-12) << "in an image of the same moment somebody did";
  searched_.clear();
  frames_.push_back(frameWith(3, 19.5, {chair}));
  EXPECT_NEAR(of({chair}).detected, std::log(3.0 / 2), 1e-12) << "half a second earlier is another view";
  EXPECT_NEAR(of({behind_the_wall}).detected, 0, 1e-12) << "never in good view";
}

// Carried away after the second sighting: the third view is from beside the first, the fourth from where it was never sighted, the
// fifth from beside the second.
TEST_F(Evidence, MissedFromWhereItWasSightedBefore) {
  const Landmark chair = landmarkOf(1, "chair", 3, 0);
  const std::vector<Pose2> places{{0, 0, 0}, {0.8, 0, 0}, {0.3, 0, 0}, {0.2, 0.7, -0.2}, {1, 0, 0}};
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double t = 100.0 * static_cast<double>(i);
    if (i > 0) poses_.add(t, toPose3(places[i]));
    memory_.add(frameOfDepth(static_cast<int>(i), t, 3), toPose3(places[i]));
  }
  EXPECT_EQ(of({chair}).missed_since, 0) << "never sighted";
  frames_ = {frameWith(0, 0, {chair}), frameWith(1, 100.2, {chair})};
  EXPECT_EQ(of({chair}).missed_since, 2);
  searched_ = {{0, {}}, {100, {}}, {200, {"chair"}}, {300, {}}, {400, {}}};
  EXPECT_EQ(of({chair}).missed_since, 1) << "nobody looked for chairs in the third";
  searched_.clear();
  frames_.push_back(frameWith(2, 399.9, {chair}));
  EXPECT_EQ(of({chair}).missed_since, 0) << "it was there at the last one";
  frames_.pop_back();
  for (const int i : {1, 2}) {
    poses_.add(400 + 20 * i, toPose3(places[4]));
    memory_.add(frameOfDepth(4 + i, 400 + 20 * i, 3), poseFromYpr(1 + 0.2 * i, 0, 0, 0, 0, 0));
  }
  EXPECT_EQ(of({chair}).missed_since, 3) << "twenty seconds later it is the same visit, after forty another one";
}

}  // namespace
}  // namespace roomgraph::test
