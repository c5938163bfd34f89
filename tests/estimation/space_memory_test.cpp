// SPDX-License-Identifier: BSD-3-Clause
// SpaceMemory: points before, at and behind what depth images and scans measured, at poses that change later.
#include "space_memory.h"

#include <gtest/gtest.h>

#include <cmath>

#include "still_camera.h"

namespace roomgraph::test {
namespace {

std::string text(const RayCounts& c) {
  return std::to_string(c.crossed) + " crossed, " + std::to_string(c.filled) + " filled, " +
         std::to_string(c.hidden) + " hidden";
}

// A wall 3 m ahead of a camera 1 m above the floor.
class OneWall : public ::testing::Test {
 protected:
  OneWall() : poses_(standing()) { poses_.add(0, Pose3::Identity()); }

  std::string at(const Eigen::Vector3d& point) const {
    return text(memory_.posed(poses_).byImages({point}).at(0));
  }

  KeyPoses poses_;
  SpaceMemory memory_;
};

TEST_F(OneWall, PointsBeforeItAreCrossedAndPointsBehindItHidden) {
  memory_.add(frameOfDepth(0, 0, 3), Pose3::Identity());
  EXPECT_EQ(at({2, 0, 1}), "1 crossed, 0 filled, 0 hidden");
  EXPECT_EQ(at({3, 0.5, 1.5}), "0 crossed, 1 filled, 0 hidden");
  EXPECT_EQ(at({4, 0, 1}), "0 crossed, 0 filled, 1 hidden");
  const std::string unseen = "0 crossed, 0 filled, 0 hidden";
  EXPECT_EQ(at({-2, 0, 1}), unseen) << "behind the camera";
  EXPECT_EQ(at({2, 2 * 160.0 / 260 + 0.05, 1}), unseen)
      << "left of the image, whose border is at 160 px of 260";
  EXPECT_EQ(at({2, 2 * 160.0 / 260 - 0.05, 1}), "1 crossed, 0 filled, 0 hidden");
}

TEST_F(OneWall, PixelsWithoutDepthSayNothing) {
  Frame frame = frameOfDepth(0, 0, 3);
  frame.depth.colRange(0, 160) = 0.f;
  memory_.add(frame, Pose3::Identity());
  EXPECT_EQ(at({2, 0.5, 1}), "0 crossed, 0 filled, 0 hidden") << "the left half";
  EXPECT_EQ(at({2, -0.5, 1}), "1 crossed, 0 filled, 0 hidden");
}

// The box covers the right half and goes on beyond the image.
TEST_F(OneWall, PeopleHideWhatTheyFill) {
  memory_.add(frameOfDepth(0, 0, 3), Pose3::Identity(), {Box2{160, -20, 400, 300}});
  EXPECT_EQ(at({2, -0.5, 1}), "0 crossed, 0 filled, 1 hidden");
  EXPECT_EQ(at({3, -0.5, 1}), "0 crossed, 0 filled, 1 hidden");
  EXPECT_EQ(at({2, 0.5, 1}), "1 crossed, 0 filled, 0 hidden") << "beside the box";
}

TEST_F(OneWall, AViewCountsOnceAndOneFromElsewhereAgain) {
  for (int i = 0; i < 5; ++i) memory_.add(frameOfDepth(i, 0.1 * i, 3), poseFromYpr(0.01 * i, 0, 0, 0, 0, 0));
  EXPECT_EQ(at({2, 0, 1}), "1 crossed, 0 filled, 0 hidden");
  memory_.add(frameOfDepth(5, 0.5, 3), poseFromYpr(0.3, 0, 0, 0, 0, 0));
  EXPECT_EQ(at({2, 0, 1}), "2 crossed, 0 filled, 0 hidden");
  memory_.add(frameOfDepth(6, 0.6, 3), poseFromYpr(0.3, 0, 0, 0.2, 0, 0));
  EXPECT_EQ(at({2, 0, 1}), "3 crossed, 0 filled, 0 hidden") << "turned";
  memory_.add(frameAt(7, 0.7), poseFromYpr(1, 0, 0, 0, 0, 0));
  EXPECT_EQ(at({2, 0, 1}), "3 crossed, 0 filled, 0 hidden") << "a frame without depth";
}

TEST_F(OneWall, ViewsMoveWithTheKeyPoses) {
  memory_.add(frameOfDepth(0, 0, 3), Pose3::Identity());
  const Pose3 moved = poseFromYpr(5, -3, 0, M_PI / 2, 0, 0);  // the wall is now at y = 0
  poses_.set(NodeId{0}, moved);
  EXPECT_EQ(at({5, -1, 1}), "1 crossed, 0 filled, 0 hidden");
  EXPECT_EQ(at({5, 0, 1}), "0 crossed, 1 filled, 0 hidden");
  EXPECT_EQ(at({2, 0, 1}), "0 crossed, 0 filled, 0 hidden");
}

// Beams every degree from -135 to 135 degrees, .25 m above the floor; the first is at the right.
Scan roundScan(float range_m) {
  Scan scan;
  scan.ranges_m.assign(271, range_m);
  scan.valid.assign(271, 1);
  scan.angle_min_rad = -135 * M_PI / 180;
  scan.angle_step_rad = M_PI / 180;
  scan.max_range_m = 10;
  scan.robot_from_lidar.translation().z() = 0.25;
  return scan;
}

class RoundRoom : public OneWall {
 protected:
  std::string onGround(double x, double y, double low_m = 0, double high_m = 1) const {
    return text(memory_.posed(poses_).byScans({{x, y}}, low_m, high_m).at(0));
  }
};

TEST_F(RoundRoom, PointsAreComparedWithTheBeamTowardsThem) {
  Scan scan = roundScan(4);
  for (std::size_t i = 0; i < 10; ++i) scan.ranges_m[135 + 80 + i] = 1;  // from 80 to 89 degrees
  scan.valid[135 - 90] = 0;
  memory_.add(scan, Pose3::Identity());
  EXPECT_EQ(onGround(2, 0), "1 crossed, 0 filled, 0 hidden");
  EXPECT_EQ(onGround(4, 0), "0 crossed, 1 filled, 0 hidden");
  EXPECT_EQ(onGround(4.5, 0), "0 crossed, 0 filled, 1 hidden");
  EXPECT_EQ(onGround(2 * std::cos(1.48), 2 * std::sin(1.48)), "0 crossed, 0 filled, 1 hidden")
      << "at 84.8 degrees";
  EXPECT_EQ(onGround(2 * std::cos(1.30), 2 * std::sin(1.30)), "1 crossed, 0 filled, 0 hidden")
      << "at 74.5 degrees";
  const std::string unseen = "0 crossed, 0 filled, 0 hidden";
  EXPECT_EQ(onGround(0, -2), unseen) << "a beam without a return";
  EXPECT_EQ(onGround(-2, 0), unseen) << "where the scanner has no beam";
}

// A post to the left, seen by a lidar that hangs upside down: its beams turn the other way round.
TEST_F(RoundRoom, ALidarUpsideDownSeesNothingMirrored) {
  Scan scan = roundScan(4);
  scan.robot_from_lidar = poseFromYpr(0, 0, 0.25, 0, 0, M_PI);
  for (std::size_t i = 0; i < 10; ++i) scan.ranges_m[135 - 60 + i] = 2;  // 51 to 60 degrees to the left in the room
  memory_.add(scan, Pose3::Identity());
  const double angle = 55 * M_PI / 180;
  EXPECT_EQ(onGround(2 * std::cos(angle), 2 * std::sin(angle)), "0 crossed, 1 filled, 0 hidden");
  EXPECT_EQ(onGround(2 * std::cos(angle), -2 * std::sin(angle)), "1 crossed, 0 filled, 0 hidden");
}

TEST_F(RoundRoom, ALidarWhoseRangeIsNotKnownSeesToItsReturns) {
  for (const double range_m : {0.0, 10.0, 1.5}) {
    memory_ = {};
    Scan scan = roundScan(4);
    scan.max_range_m = range_m;
    memory_.add(scan, Pose3::Identity());
    EXPECT_EQ(onGround(2, 0), range_m == 1.5 ? "0 crossed, 0 filled, 0 hidden" : "1 crossed, 0 filled, 0 hidden") << range_m;
  }
}

TEST_F(RoundRoom, BeamsBeyondHalfATurnAndBackwardsAreFound) {
  Scan scan = roundScan(4);
  scan.angle_min_rad = 0;  // from 0 to 270 degrees
  scan.ranges_m[225] = 1;
  memory_.add(scan, Pose3::Identity());
  EXPECT_EQ(onGround(-1.41, -1.41), "0 crossed, 0 filled, 1 hidden") << "at 225, which is -135 degrees";
  EXPECT_EQ(onGround(1.41, -1.41), "0 crossed, 0 filled, 0 hidden") << "at 315 degrees";
  scan.angle_step_rad = -scan.angle_step_rad;
  memory_.add(scan, poseFromYpr(0, 0, 0, 1, 0, 0));
  EXPECT_EQ(onGround(-1.41, 1.41), "1 crossed, 0 filled, 1 hidden") << "at -225, which is 135 degrees";
}

TEST_F(RoundRoom, OnlyScansAtTheAskedHeightsCount) {
  memory_.add(roundScan(4), Pose3::Identity());
  EXPECT_EQ(onGround(2, 0, 0.3, 1), "0 crossed, 0 filled, 0 hidden");
  EXPECT_EQ(onGround(2, 0, 0, 0.2), "0 crossed, 0 filled, 0 hidden");
  EXPECT_EQ(onGround(2, 0, 0.2, 0.3), "1 crossed, 0 filled, 0 hidden");
}

TEST(SpaceMemory, WithoutKeyPosesThereAreNoViews) {
  SpaceMemory memory;
  memory.add(frameOfDepth(0, 0, 3), Pose3::Identity());
  const KeyPoses none(standing());
  EXPECT_EQ(text(memory.posed(none).byImages({{2, 0, 1}}).at(0)), "0 crossed, 0 filled, 0 hidden");
}

}  // namespace
}  // namespace roomgraph::test
