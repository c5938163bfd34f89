// SPDX-License-Identifier: BSD-3-Clause
// Trajectory: interpolation, extrapolation and segments.
#include "roomgraph/observations/trajectory.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "roomgraph/observations/trajectory_velocity.h"

namespace roomgraph {
namespace {

Pose3 flat(double x, double y = 0, double yaw = 0) {
  return toPose3(Pose2{x, y, yaw});
}

// 1 m/s along x while turning .2 rad/s.
Trajectory drive() {
  Trajectory out;
  for (const double t : {1.0, 2.0, 4.0}) out.add(t, flat(t, 0, 0.2 * t));
  return out;
}

TEST(Trajectory, TimesMustRise) {
  Trajectory trajectory = drive();
  EXPECT_THROW(trajectory.add(4, flat(0)), std::invalid_argument);
  EXPECT_THROW(trajectory.add(3, flat(0)), std::invalid_argument);
  EXPECT_EQ(trajectory.size(), 3u);
  EXPECT_EQ(trajectory.firstTime(), 1);
  EXPECT_EQ(trajectory.lastTime(), 4);
}

TEST(Trajectory, InterpolatesBetweenPoses) {
  const auto trajectory = drive();
  for (const double t : {1.0, 1.25, 2.0, 3.0, 3.9, 4.0}) {
    const auto pose = trajectory.at(t);
    ASSERT_TRUE(pose.has_value()) << t;
    EXPECT_TRUE(pose->isApprox(flat(t, 0, 0.2 * t), 1e-9)) << t;
  }
}

TEST(Trajectory, HorizonAtBothEnds) {
  const auto trajectory = drive();
  for (const double t : {0.9, 4.1}) {
    EXPECT_FALSE(trajectory.at(t).has_value());
    EXPECT_FALSE(trajectory.at(t, 0.05).has_value());
    ASSERT_TRUE(trajectory.at(t, 0.2).has_value());
    EXPECT_TRUE(trajectory.at(t, 0.2)->isApprox(flat(t, 0, 0.2 * t), 1e-9))
        << "goes on with the last velocity";
  }
}

// Two stamps of a burst, half a millisecond apart, at both ends: the velocity is that of the poses around them.
TEST(Trajectory, GoesOnWithAVelocityOverMoreThanABurst) {
  Trajectory trajectory;
  trajectory.add(0, flat(0));
  for (int i = 1; i <= 10; ++i) {
    trajectory.add(0.05 * i, flat(0.025 * i));
    if (i == 1) trajectory.add(0.0505, flat(0.027));
  }
  trajectory.add(0.5005, flat(0.253));  // .5 m/s until then, 6 m/s in the burst
  EXPECT_NEAR(trajectory.at(0.65, 0.2)->translation().x(), 0.253 + 0.1495 * (0.253 - 0.225) / 0.0505, 1e-9);
  EXPECT_EQ(velocityBase(trajectory, true), trajectory.size() - 3);
  EXPECT_NEAR(trajectory.at(-0.1, 0.2)->translation().x(), -0.05, 1e-9);
  Trajectory burst;
  burst.add(1, flat(0));
  burst.add(1.0005, flat(0.01));
  EXPECT_NEAR(burst.at(1.1, 0.2)->translation().x(), 0.01, 1e-12) << "alone it tells no velocity";
  EXPECT_NEAR(burst.at(0.9, 0.2)->translation().x(), 0, 1e-12);
  EXPECT_FALSE(velocityBase(burst, true));
  burst.add(2, flat(5), 1);
  EXPECT_FALSE(velocityBase(burst, true)) << "of another segment";
}

TEST(Trajectory, EmptyAndSinglePose) {
  EXPECT_FALSE(Trajectory().at(1, 100).has_value());
  EXPECT_FALSE(Trajectory().between(1, 2, 100).has_value());
  Trajectory one;
  one.add(5, flat(3));
  EXPECT_TRUE(one.at(5)->isApprox(flat(3)));
  EXPECT_TRUE(one.at(5.1, 0.2)->isApprox(flat(3)));
  EXPECT_FALSE(one.at(5.1).has_value());
}

TEST(Trajectory, NothingBetweenSegments) {
  Trajectory trajectory;
  trajectory.add(0, flat(0), 0);
  trajectory.add(1, flat(1), 0);
  trajectory.add(2, flat(50), 1);
  trajectory.add(3, flat(51), 1);
  EXPECT_FALSE(trajectory.at(1.5).has_value());
  EXPECT_FALSE(trajectory.at(1.5, 1).has_value()) << "the horizon is for the ends only";
  EXPECT_TRUE(trajectory.at(2.5)->isApprox(flat(50.5), 1e-9));
  EXPECT_FALSE(trajectory.between(0.5, 2.5).has_value());
  EXPECT_TRUE(trajectory.between(2, 3)->isApprox(flat(1), 1e-9));
  EXPECT_TRUE(trajectory.between(0, 1)->isApprox(flat(1), 1e-9));
  EXPECT_EQ(trajectory.segment(2), 1);
}

TEST(Trajectory, SegmentOfOnePoseAtTheEnd) {
  Trajectory trajectory;
  trajectory.add(0, flat(0), 0);
  trajectory.add(1, flat(1), 0);
  trajectory.add(2, flat(50), 1);
  ASSERT_TRUE(trajectory.at(2.1, 0.2).has_value());
  EXPECT_TRUE(trajectory.at(2.1, 0.2)->isApprox(flat(50), 1e-9)) << "one pose has no velocity";
}

TEST(Trajectory, BetweenIsTheMovementInTheFirstFrame) {
  const auto trajectory = drive();
  const auto movement = trajectory.between(1.5, 3);
  ASSERT_TRUE(movement.has_value());
  EXPECT_TRUE((flat(1.5, 0, 0.3) * *movement).isApprox(flat(3, 0, 0.6), 1e-9));
  EXPECT_TRUE(trajectory.between(3, 1.5)->isApprox(movement->inverse(), 1e-9));
}

}  // namespace
}  // namespace roomgraph
