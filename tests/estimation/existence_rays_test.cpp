// SPDX-License-Identifier: BSD-3-Clause
// Evidence for existence by depth images and scans: rays through volumes, walls beside doors, beams through what is solid.
#include <cmath>

#include "evidence_fixture.h"

namespace roomgraph::test {
namespace {

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

TEST_F(Evidence, OneBeamThatSeemsToEndInsideIsNoWallWhereMostEndAtTheFront) {
  memory_.add(halfRound(2.9f), Pose3::Identity());
  const auto again = [&](int i, float range_m = 2.6f) {
    Scan scan = halfRound(range_m);
    scan.t = i;
    const Pose3 beside = poseFromYpr(0, i % 2 ? 0.2 : 0, 0, 0, 0, 0);
    poses_.add(i, beside);
    memory_.add(scan, beside);
  };
  for (int i = 1; i <= 4; ++i) again(i);
  EXPECT_GT(of({landmarkOf(1, "sofa", 3, 0)}).beams_crossed, 0.5);
  again(5);
  EXPECT_NEAR(of({landmarkOf(1, "sofa", 3, 0)}).beams_crossed, 0, 1e-12);
  memory_ = {};
  memory_.add(halfRound(2.9f), Pose3::Identity());
  for (int i = 6; i <= 15; ++i) again(i, 1.5f);
  EXPECT_GT(of({landmarkOf(1, "sofa", 3, 0)}).beams_crossed, 0.5) << "beams that end elsewhere say nothing";
}

}  // namespace
}  // namespace roomgraph::test
