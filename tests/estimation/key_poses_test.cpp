// SPDX-License-Identifier: BSD-3-Clause
// KeyPoses: interpolation between key poses, ends, and nearest in time.
#include "roomgraph/estimation/key_poses.h"

#include <gtest/gtest.h>

namespace roomgraph::test {
namespace {

// One source: 1 m/s along its x axis, which points along -y of world, from second 0 to 4.
Motion straightOn() {
  const MotionNoise noise;
  Motion motion{MotionSource(noise, true), MotionSource(noise, false), MotionSource(noise, true)};
  for (int i = 0; i <= 8; ++i)
    motion.lidar.add(0.5 * i, poseFromYpr(50 + 0.5 * i, 7, 0, 0, 0, 0), 0, Matrix6d::Zero());
  return motion;
}

Pose3 heading(double x, double y) {
  return poseFromYpr(x, y, 0, -M_PI / 2, 0, 0);
}

void expectPlace(const Pose3& pose, double x, double y) {
  EXPECT_NEAR(pose.translation().x(), x, 1e-12);
  EXPECT_NEAR(pose.translation().y(), y, 1e-12);
  EXPECT_NEAR(planarPart(pose).yaw, -M_PI / 2, 1e-12);
}

TEST(KeyPoses, BetweenTwoTheSourceIsBentSoThatItMeetsBoth) {
  const Motion motion = straightOn();
  KeyPoses poses(motion);
  poses.add(1, heading(0, 0));
  poses.add(3, heading(0.2, -2));  // the graph moved it 20 cm sideways
  expectPlace(poses.at(1), 0, 0);
  expectPlace(poses.at(3), 0.2, -2);
  expectPlace(poses.at(2), 0.1, -1);
  expectPlace(poses.at(1.5), 0.05, -0.5);
  expectPlace(poses.at(2.75), 0.175, -1.75);
}

TEST(KeyPoses, BeyondTheEndsTheSourceGoesOn) {
  const Motion motion = straightOn();
  KeyPoses poses(motion);
  poses.add(1, heading(0, 0));
  poses.add(3, heading(0.2, -2));
  expectPlace(poses.at(0.5), 0, 0.5);
  expectPlace(poses.at(3.5), 0.2, -2.5);
}

// Lost at second 4 and found again, elsewhere, in a segment of its own at second 9: each side goes on by itself.
TEST(KeyPoses, AGapDoesNotDrawTheWayBeforeItToThePlaceBehindIt) {
  Motion motion = straightOn();
  for (int i = 0; i <= 4; ++i) motion.lidar.add(9 + 0.5 * i, poseFromYpr(0.5 * i, 0, 0, 0, 0, 0), 1, Matrix6d::Zero());
  KeyPoses poses(motion);
  poses.add(2, heading(0, 0));
  poses.add(10, heading(30, -40));
  expectPlace(poses.at(3.5), 0, -1.5);
  expectPlace(poses.at(9.5), 30, -39.5);
  EXPECT_LT((poses.at(6).translation() - Eigen::Vector3d(15, -20, 0)).norm(), 1e-12) << "within it nothing is known: half way";
}

TEST(KeyPoses, HoldsStillWhereNoSourceReaches) {
  const Motion motion = straightOn();
  KeyPoses poses(motion);
  poses.add(1, heading(0, 0));
  expectPlace(poses.at(100), 0, 0);
  expectPlace(poses.at(-100), 0, 0);
}

TEST(KeyPoses, BetweenIsWhatTheirTrajectorySays) {
  const Motion motion = straightOn();
  KeyPoses poses(motion);
  EXPECT_FALSE(poses.between(1));
  poses.add(1, heading(0, 0));
  poses.add(3, poseFromYpr(0.2, -2, 0.1, 0.4, 0.1, 0.2));
  poses.add(3.5, poseFromYpr(1, -2, 0.1, 1.4, 0, 0.2));
  const Trajectory trajectory = poses.trajectory();
  for (const double t : {0.9, 1.0, 1.2, 2.7, 3.0, 3.1, 3.5, 3.6}) {
    const auto expected = trajectory.at(t), is = poses.between(t);
    ASSERT_EQ(is.has_value(), expected.has_value()) << t;
    if (expected) {
      EXPECT_EQ(is->matrix(), expected->matrix()) << t;
    }
  }
}

TEST(KeyPoses, NearestInTime) {
  const Motion motion = straightOn();
  KeyPoses poses(motion);
  for (double t : {1.0, 2.0, 4.0}) poses.add(t, Pose3::Identity());
  const auto nearest = [&](double t) { return poses.nearest(t).t; };
  EXPECT_EQ(nearest(-5), 1);
  EXPECT_EQ(nearest(1.4), 1);
  EXPECT_EQ(nearest(1.6), 2);
  EXPECT_EQ(nearest(2.9), 2);
  EXPECT_EQ(nearest(3.1), 4);
  EXPECT_EQ(nearest(99), 4);
}

TEST(KeyPoses, OffsetIsTheMovementFromTheKeyPose) {
  const Motion motion = straightOn();
  KeyPoses poses(motion);
  poses.add(1, heading(5, 5));
  const Pose3 offset = poses.offset(poses.nodes()[0], 1.4);
  EXPECT_LT((offset.translation() - Eigen::Vector3d(0.4, 0, 0)).norm(), 1e-12);
  EXPECT_TRUE(poses.offset(poses.nodes()[0], 1).isApprox(Pose3::Identity()));
}

}  // namespace
}  // namespace roomgraph::test
