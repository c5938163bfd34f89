// SPDX-License-Identifier: BSD-3-Clause
// DenseChain of a robot: what a bare wall leaves open, and what is known where nothing is seen.
#include "dense_chain.h"

#include <gtest/gtest.h>

#include <cmath>

#include "textured_room.h"

namespace roomgraph::tracking {
namespace {

using test::TexturedRoom;

Frame withoutPicture(double t, bool depth) {
  const TexturedRoom room;
  Frame frame = room.render(t, Pose3::Identity());
  frame.gray.setTo(128);
  frame.depth.setTo(depth ? 2.0 : 0.0);
  return frame;
}

CarryingBody onWheels() {
  CarryingBody out;
  out.camera_from_body.linear() = bodyFromOptical().transpose();
  out.scatter[0] = out.scatter[5] = std::numeric_limits<double>::infinity();
  return out;
}

// Of what comes next, along and about the robot's own axes at the end.
Vector6d sigmasAlongTheRobot(const ChainedMovement& movement) {
  const Eigen::Matrix3d robot_from_first =
      bodyFromOptical() * movement.first_from_current.linear().transpose();
  return rotateCovariance(movement.covariance, robot_from_first).diagonal().cwiseSqrt();
}

// Ahead and turns are unknown, sideways is not; a turn moves the end sideways by half the way.
TEST(DenseChain, WhereNothingIsSeenARobotIsOnAnArcAhead) {
  DenseChain chain;
  chain.begin(withoutPicture(0, false), {}, true);
  Pose3 ahead = Pose3::Identity();
  ahead.translation().z() = 0.4;
  const auto by_hand = chain.follow(withoutPicture(1, false), {}, {ahead});
  chain.begin(withoutPicture(0, false), {}, true);
  const auto on_wheels = chain.follow(withoutPicture(1, false), {}, {ahead, false, {}, onWheels()});
  ASSERT_TRUE(by_hand && on_wheels);
  EXPECT_FALSE(on_wheels->seen);
  const Vector6d hand = sigmasAlongTheRobot(*by_hand), wheels = sigmasAlongTheRobot(*on_wheels);
  EXPECT_NEAR(hand[0], 0.3, 0.01);
  EXPECT_NEAR(hand[1], 0.3, 0.01);
  EXPECT_NEAR(hand[5], 0.5, 0.01);
  EXPECT_NEAR(wheels[0], 0.3, 0.01);
  EXPECT_NEAR(wheels[1], std::hypot(0.03, 0.2 * 0.5), 0.01);
  EXPECT_NEAR(wheels[2], 0.03, 0.01);
  EXPECT_LT(wheels[3], 0.03);
  EXPECT_LT(wheels[4], 0.03);
  EXPECT_NEAR(wheels[5], 0.5, 0.01);
  // To the left, the more it turned to the left.
  const Matrix6d robot = rotateCovariance(on_wheels->covariance, Eigen::Matrix3d(bodyFromOptical()));
  EXPECT_NEAR(robot(1, 5) / robot(5, 5), 0.2, 0.02) << "half the way";
}

TEST(DenseChain, AlongABareWallARobotDoesNotSlip) {
  Pose3 sideways = Pose3::Identity();
  sideways.translation().x() = 0.02;
  const auto sigmaSideways = [&](const std::optional<CarryingBody>& body) {
    DenseChain chain;
    chain.begin(withoutPicture(0, true), {}, true);
    const auto moved = chain.follow(withoutPicture(0.5, true), {}, {sideways, false, {}, body});
    EXPECT_TRUE(moved && moved->seen);
    return moved ? sigmasAlongTheRobot(*moved)[1] : 0;
  };
  EXPECT_NEAR(sigmaSideways({}), 0.15 * 0.5, 0.015);
  EXPECT_LT(sigmaSideways(onWheels()), 0.03);
}

// Five centimetres in a tenth of a second are possible where the velocity is not known; wheels know it.
TEST(DenseChain, WhatOtherSensorsMeasuredIsNotDeniedByALikeness) {
  const TexturedRoom room;
  const auto seenAs = [&](bool measured) {
    DenseChain chain;
    chain.begin(room.render(0, Pose3::Identity()), {}, false);
    const auto moved = chain.follow(room.render(0.1, poseFromYpr(0.05, 0, 0, 0, 0, 0)), {}, {Pose3::Identity(), measured});
    EXPECT_TRUE(moved);
    return moved && moved->seen;
  };
  EXPECT_TRUE(seenAs(false));
  EXPECT_FALSE(seenAs(true));
  // At a fifth of a second the velocity alone allows them, wheels that know the step to half a centimetre do not.
  const auto seenAfter = [&](double sigma_m) {
    DenseChain chain;
    chain.begin(room.render(0, Pose3::Identity()), {}, true);
    DenseChain::Prediction predicted{Pose3::Identity(), true};
    predicted.sigma_m = sigma_m;
    const auto moved = chain.follow(room.render(0.2, poseFromYpr(0.05, 0, 0, 0, 0, 0)), {}, predicted);
    EXPECT_TRUE(moved);
    return moved && moved->seen;
  };
  EXPECT_TRUE(seenAfter(std::numeric_limits<double>::infinity()));
  EXPECT_TRUE(seenAfter(0.05));
  EXPECT_FALSE(seenAfter(0.005));
  // But where the velocity led there, wheels have slipped.
  DenseChain chain;
  const Pose3 moved = poseFromYpr(0.05, 0, 0, 0, 0, 0);
  chain.begin(room.render(0, Pose3::Identity()), {}, true);
  const auto by_velocity = chain.follow(room.render(0.1, moved), {}, {poseFromYpr(0.4, 0, 0, 0, 0, 0), true, moved});
  ASSERT_TRUE(by_velocity);
  EXPECT_TRUE(by_velocity->seen);
  EXPECT_LT((by_velocity->first_from_current.translation() - moved.translation()).norm(), 0.005);
}

}  // namespace
}  // namespace roomgraph::tracking
