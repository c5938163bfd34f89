// SPDX-License-Identifier: BSD-3-Clause
// Evidence for existence: means over sightings by hand, rays through volumes, walls beside doors, contested
// boxes.
#include "existence_evidence.h"

#include <gtest/gtest.h>

#include <cmath>

#include "still_camera.h"

namespace roomgraph::test {
namespace {

const ObjectDatabase& database() {
  static const ObjectDatabase out = ObjectDatabase::fromText(
      "[chair]\nlabels = chair\nshape = cylinder\nwidth_m = .6\ndepth_m = .6\nheight_m = .9\n"
      "width_sigma_m = .1\ndepth_sigma_m = .1\nheight_sigma_m = .1\nsymmetry = 0\n"
      "[sofa]\nlabels = sofa\nshape = cuboid\nwidth_m = 1.8\ndepth_m = .8\nheight_m = .8\nsolid_share = .5\n"
      "[door]\nlabels = door\nshape = planar\nwidth_m = .9\ndepth_m = .1\nheight_m = 2\nsymmetry = 2\n");
  return out;
}

Landmark landmarkOf(int id, const std::string& class_name, double x, double y) {
  Landmark out;
  out.id = LandmarkId{id};
  out.class_name = class_name;
  out.shape = database().find(class_name)->nominal();
  out.position = {x, y, 0};
  out.existence = 0.9;
  out.class_posterior = {{class_name, 0.75}, {"other", 0.25}};
  out.observations = 10;
  return out;
}

// Seen as its landmark is, in a frame without depth.
ObjectFrame frameWith(int i, double t, const std::vector<Landmark>& seen) {
  const Frame frame = frameAt(i, t);
  ObjectFrame out{frame.id, t, frame.camera, frame.robot_from_camera, {}, {}};
  for (const auto& landmark : seen) {
    ObjectDecision decision;
    decision.landmark = landmark.id;
    decision.seen.world_from_object = landmark.worldFromObject();
    auto& measurement = decision.seen.measurement;
    measurement.proposal.class_name = landmark.class_name;
    measurement.proposal.score = 0.5;
    const auto projected = projectShape(
        landmark.shape, frame.robot_from_camera.inverse() * landmark.worldFromObject(), frame.camera);
    measurement.detection.box = projected->visible;
    out.decisions.push_back(decision);
  }
  return out;
}

class Evidence : public ::testing::Test {
 protected:
  Evidence() : poses_(standing()) { poses_.add(0, Pose3::Identity()); }

  ExistenceEvidence of(const std::vector<Landmark>& landmarks) const {
    return existenceEvidence(landmarks, frames_, poses_, memory_.posed(poses_), database(), searched_).at(0);
  }

  // This image alone is remembered.
  void see(const Frame& frame) {
    memory_ = {};
    memory_.add(frame, Pose3::Identity());
  }

  KeyPoses poses_;
  SpaceMemory memory_;
  std::vector<ObjectFrame> frames_;
  std::vector<SearchedImage> searched_;
};

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

TEST_F(Evidence, RaysThroughAndIntoAVolume) {
  const Landmark sofa = landmarkOf(1, "sofa", 3, 0);
  memory_.add(frameOfDepth(0, 0, 6), Pose3::Identity());
  ExistenceEvidence evidence = of({sofa});
  EXPECT_NEAR(evidence.crossed, 1, 1e-12) << "the wall is 2.5 m behind it";
  EXPECT_NEAR(evidence.filled + evidence.spread, 0, 1e-12);
  memory_ = {};
  memory_.add(frameOfDepth(0, 0, 2.6F), Pose3::Identity());
  evidence = of({sofa});
  EXPECT_NEAR(evidence.crossed, 0, 1e-12) << "its front is at 2.6 m";
  EXPECT_GT(evidence.filled, 0.1);
  EXPECT_LT(evidence.filled, 0.4) << "the first .15 of .66 m, within .1 m and 2 % of 2.6 m";
  EXPECT_NEAR(evidence.spread, 0.4, 0.21) << "one to three of five slices from front to back";
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

// Half of the sofa's length is air.
TEST_F(Evidence, SpreadIsTheShareOfTheLengthThatIsThere) {
  const Landmark sofa = landmarkOf(1, "sofa", 3, 0);
  Frame frame = frameOfDepth(0, 0, 6);
  frame.depth.colRange(160, 320) = 2.9F;  // the right half, y < 0
  memory_.add(frame, Pose3::Identity());
  const ExistenceEvidence evidence = of({sofa});
  EXPECT_NEAR(evidence.spread, 0.4, 0.21);
  EXPECT_NEAR(evidence.crossed, std::sqrt(0.5), 0.07);
}

TEST_F(Evidence, ADoorIsInAWall) {
  const Landmark door = landmarkOf(1, "door", 3, 0);
  memory_.add(frameOfDepth(0, 0, 3), Pose3::Identity());
  ExistenceEvidence evidence = of({door});
  EXPECT_NEAR(evidence.beside_filled, 1, 1e-12);
  EXPECT_NEAR(evidence.beside_crossed, 0, 1e-12);
  memory_ = {};
  memory_.add(frameOfDepth(0, 0, 3.4F), Pose3::Identity());
  evidence = of({door});
  EXPECT_NEAR(evidence.beside_crossed, 1, 1e-12) << "the front of a cupboard stands before the wall";
  EXPECT_NEAR(evidence.beside_filled, 0, 1e-12);
  EXPECT_NEAR(of({landmarkOf(1, "sofa", 3, 0)}).beside_crossed, 0, 1e-12) << "asked of doors only";
}

// Rows of the image that see the plane at `range_m` between two heights; the camera is at 1 m and level.
cv::Range rowsBetween(double low_m, double high_m, double range_m) {
  const auto row = [&](double z_m) {
    return static_cast<int>(std::lround(119.5 + 260 * (1 - z_m) / range_m));
  };
  return {std::max(0, row(high_m)), std::min(240, row(low_m))};
}

// Its front below 1.3 m, and the wall .4 m behind it above that.
TEST_F(Evidence, ACupboardIsNotAsHighAsADoor) {
  const Landmark door = landmarkOf(1, "door", 4, 0);
  Frame frame = frameOfDepth(0, 0, 4.4F);
  frame.depth.rowRange(rowsBetween(0, 1.3, 4)) = 4.F;
  see(frame);
  EXPECT_NEAR(of({door}).uneven, 1, 1e-12);
  for (const float depth_m : {4.F, 8.F}) {
    see(frameOfDepth(0, 0, depth_m));
    EXPECT_NEAR(of({door}).uneven, 0, 1e-12) << "closed, or open, all the way up";
  }
  frame = frameOfDepth(0, 0, 0);
  frame.depth.rowRange(rowsBetween(0, 0.9, 4)) = 4.F;
  see(frame);
  EXPECT_NEAR(of({door}).uneven, 0, 1e-12) << "nothing is known about its upper part";
}

// A coat stand 1.6 m high, of which a part was taken for a chair.
TEST_F(Evidence, WhatGoesOnAboveIsHigher) {
  const Landmark chair = landmarkOf(1, "chair", 4, 0);
  Frame frame = frameOfDepth(0, 0, 8);
  frame.depth.rowRange(rowsBetween(0, 0.9, 4)) = 4.F;
  see(frame);
  EXPECT_NEAR(of({chair}).above_filled, 0, 1e-12);
  frame.depth.rowRange(rowsBetween(0, 1.6, 4)) = 4.F;
  see(frame);
  EXPECT_GT(of({chair}).above_filled, 0.3) << "at the middle of the footprint, within .1 m";
  frame.depth.colRange(120, 200) = 2.F;
  see(frame);
  EXPECT_NEAR(of({chair}).above_filled, 0, 1e-12) << "hidden";
}

// Half a turn of beams, all of one length, .3 m above the floor.
Scan halfRound(float range_m) {
  Scan scan;
  scan.ranges_m.assign(181, range_m);
  scan.valid.assign(181, 1);
  scan.angle_min_rad = -M_PI / 2;
  scan.angle_step_rad = M_PI / 180;
  scan.max_range_m = 10;
  scan.robot_from_lidar.translation().z() = 0.3;
  return scan;
}

TEST_F(Evidence, BeamsThroughWhatIsSolid) {
  Scan scan = halfRound(6);
  memory_.add(scan, Pose3::Identity());
  EXPECT_NEAR(of({landmarkOf(1, "sofa", 3, 0)}).beams_crossed, 1, 1e-12);
  EXPECT_NEAR(of({landmarkOf(1, "sofa", 3, 0)}).crossed, 1, 1e-12) << "no image saw anything of it";
  EXPECT_NEAR(of({landmarkOf(1, "chair", 3, 0)}).beams_crossed, 0, 1e-12) << "beams pass between its legs";
  memory_ = {};
  scan.robot_from_lidar.translation().z() = 0.5;
  memory_.add(scan, Pose3::Identity());
  EXPECT_NEAR(of({landmarkOf(1, "sofa", 3, 0)}).beams_crossed, 0, 1e-12)
      << "over the solid part, which is .4 m high";
}

// A sofa, 1.8 x .8 m, ends beams at its sides, whichever of them the scan sees: one that a beam reaches the inside of is not there.
TEST_F(Evidence, AWallThroughWhatIsSolid) {
  memory_.add(halfRound(3), Pose3::Identity());
  EXPECT_GT(of({landmarkOf(1, "sofa", 3, 0)}).beams_crossed, 0.7) << "through its middle";
  Landmark slim = landmarkOf(1, "sofa", 3, 0);
  slim.shape.depth = 0.75;
  EXPECT_GT(of({slim}).beams_crossed, 0.7);
  slim.shape.depth = 0.65;
  slim.position.x() = 3.12;
  EXPECT_NEAR(of({slim}).beams_crossed, 0, 1e-12) << "its front may be where they end";
  EXPECT_NEAR(of({landmarkOf(1, "sofa", 3.4, 0)}).beams_crossed, 0, 1e-12) << "they end at its front";
  Landmark along = landmarkOf(1, "sofa", 3.9, 0);
  along.has_yaw = true;
  along.yaw = M_PI / 2;  // its length runs from the robot on
  EXPECT_NEAR(of({along}).beams_crossed, 0, 1e-12) << "they end at its narrow side";
  along.position.x() = 3.4;
  EXPECT_GT(of({along}).beams_crossed, 0.3);
  EXPECT_NEAR(of({landmarkOf(1, "chair", 3, 0)}).beams_crossed, 0, 1e-12) << "what stands between its legs";
}

}  // namespace
}  // namespace roomgraph::test
