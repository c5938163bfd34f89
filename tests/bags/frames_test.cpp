// SPDX-License-Identifier: BSD-3-Clause
// Frames of tf: ways, transforms at a time, places of sensors, and frames that are not what they should be.
#include <gmock/gmock.h>

#include <numbers>

#include "frame_graph.h"
#include "sensor_frames.h"

namespace roomgraph::bags {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::int64_t kSecond = 1'000'000'000;

TransformMessage link(const std::string& parent, const std::string& child, double x, std::int64_t t_ns = 0,
                      double yaw = 0) {
  TransformMessage message;
  message.header = {t_ns, parent};
  message.child_frame = child;
  message.parent_from_child = poseFromYpr(x, 0, 0, yaw, 0, 0);
  return message;
}

Pose3 opticalPose() {
  Pose3 pose = Pose3::Identity();
  pose.linear() = bodyFromOptical();
  return pose;
}

TEST(FrameGraph, WaysGoUpAndDown) {
  FrameGraph graph;
  graph.learn(link("base", "arm", 1), true);
  graph.learn(link("arm", "hand", 2, 0, std::numbers::pi / 2), true);
  graph.learn(link("base", "laser", 5), true);
  const auto hand = graph.way("base", "hand");
  ASSERT_TRUE(hand);
  EXPECT_EQ(hand->size(), 2u);
  EXPECT_NEAR(graph.at(*hand, 0)->translation().x(), 3, 1e-12);
  const auto across = graph.way("laser", "hand");
  ASSERT_TRUE(across);
  EXPECT_NEAR(graph.at(*across, 0)->translation().x(), -2, 1e-12);
  const Eigen::Vector3d tip = *graph.at(*across, 0) * Eigen::Vector3d(1, 0, 0);
  EXPECT_NEAR(tip.x(), -2, 1e-12);
  EXPECT_NEAR(tip.y(), 1, 1e-12);
  EXPECT_TRUE(graph.way("base", "base")->empty());
  EXPECT_FALSE(graph.way("base", "moon"));
  EXPECT_FALSE(graph.movingEdge(*hand));
  EXPECT_TRUE(graph.fixed(*hand));
  EXPECT_THAT(graph.frames(), ElementsAre("arm", "base", "hand", "laser"));
}

TEST(FrameGraph, WhatIsRepeatedWithTheSameNumbersIsFixed) {
  FrameGraph graph;
  for (int i = 0; i < 5; ++i) graph.learn(link("base", "camera", 0.3, i * kSecond), false);
  const auto way = graph.way("base", "camera");
  EXPECT_TRUE(graph.fixed(*way));
  EXPECT_FALSE(graph.follow(link("base", "camera", 0.3, kSecond), false, 20));
  EXPECT_NEAR(graph.at(*way, 123 * kSecond)->translation().x(), 0.3, 1e-12) << "at any time";
}

TEST(FrameGraph, MovingEdgesAreInterpolatedAndNotExtrapolated) {
  FrameGraph graph;
  graph.learn(link("odom", "base", 0), false);
  graph.learn(link("odom", "base", 1), false);
  const auto way = graph.way("odom", "base");
  ASSERT_TRUE(graph.movingEdge(*way));
  // In any order; the second of equal stamps is not taken.
  EXPECT_TRUE(graph.follow(link("odom", "base", 1, 10 * kSecond + kSecond / 2), false, 20));
  EXPECT_TRUE(graph.follow(link("odom", "base", 0, 10 * kSecond), false, 20));
  EXPECT_FALSE(graph.follow(link("odom", "base", 7, 10 * kSecond), false, 20));
  EXPECT_NEAR(graph.at(*way, 10 * kSecond)->translation().x(), 0, 1e-12);
  EXPECT_NEAR(graph.at(*way, 10 * kSecond + kSecond / 4)->translation().x(), 0.5, 1e-9);
  EXPECT_FALSE(graph.at(*way, 10 * kSecond - 1));
  EXPECT_FALSE(graph.at(*way, 10 * kSecond + kSecond / 2 + 1));
  EXPECT_TRUE(graph.follow(link("odom", "base", 2, 13 * kSecond), false, 20));
  EXPECT_FALSE(graph.at(*way, 12 * kSecond)) << "a gap of more than a second";
}

TEST(FrameGraph, OldTransformsAreForgotten) {
  FrameGraph graph;
  graph.learn(link("odom", "base", 0), false);
  graph.learn(link("odom", "base", 1), false);
  for (int i = 0; i <= 100; ++i) graph.follow(link("odom", "base", i, i * kSecond / 2), false, 5);
  const auto way = graph.way("odom", "base");
  EXPECT_FALSE(graph.at(*way, 40 * kSecond));
  EXPECT_TRUE(graph.at(*way, 46 * kSecond));
}

TEST(FrameGraph, StaticTransformsHoldUntilTheNextOne) {
  FrameGraph graph;
  graph.learn(link("base", "head", 0), true);
  graph.learn(link("base", "head", 1), false);
  graph.follow(link("base", "head", 0, kSecond), true, 20);
  const auto way = graph.way("base", "head");
  EXPECT_NEAR(graph.at(*way, 15 * kSecond)->translation().x(), 0, 1e-12);
  graph.follow(link("base", "head", 1, 16 * kSecond), false, 20);
  EXPECT_NEAR(graph.at(*way, 15 * kSecond)->translation().x(), 0, 1e-12);
  EXPECT_FALSE(graph.at(*way, 17 * kSecond));
}

TEST(FrameGraph, SeveralParentsAreTold) {
  FrameGraph graph;
  graph.learn(link("odom", "base", 0), false);
  graph.learn(link("world", "base", 0), false);
  graph.learn(link("world", "base", 1), false);
  graph.learn(link("base", "base", 1), false);
  EXPECT_THAT(graph.disputed(), ElementsAre("base"));
  EXPECT_TRUE(graph.way("odom", "world"));
}

TEST(SensorFrames, CamerasAreOpticalUnlessTheyLookAtTheCeiling) {
  FrameGraph graph;
  graph.learn(link("base", "body", 0.5), true);
  TransformMessage optical = link("body", "eye_optical_frame", 0);
  optical.parent_from_child = opticalPose();
  graph.learn(optical, true);
  SensorFrames frames(graph, "base", "");
  const auto eye = frames.opticalAt("eye_optical_frame", 0);
  ASSERT_TRUE(eye);
  EXPECT_TRUE(eye->linear().isApprox(bodyFromOptical(), 1e-12));
  EXPECT_THAT(frames.warnings(), IsEmpty());
  const auto body = frames.opticalAt("body", 0);
  ASSERT_TRUE(body);
  EXPECT_TRUE(body->linear().isApprox(bodyFromOptical(), 1e-12));
  EXPECT_NEAR(body->translation().x(), 0.5, 1e-12);
  EXPECT_THAT(frames.warnings(), ElementsAre(HasSubstr("frame 'body' of a camera is not optical")));
  EXPECT_TRUE(frames.opticalAt("body", 1));
  EXPECT_EQ(frames.warnings().size(), 1u) << "told once";
}

TEST(SensorFrames, AHandheldCameraIsTheRobot) {
  FrameGraph graph;
  TransformMessage imu = link("eye_optical", "imu", 0);
  imu.parent_from_child = opticalPose().inverse();  // beside the camera, x forward
  graph.learn(imu, true);
  SensorFrames frames(graph, "", "eye_optical");
  EXPECT_TRUE(frames.opticalAt("eye_optical", 0)->isApprox(opticalPose(), 1e-12));
  EXPECT_TRUE(frames.at("imu", 0)->isApprox(Pose3::Identity(), 1e-12));
}

TEST(SensorFrames, UnknownFramesAreAtTheRobotAndMovingOnesMayFail) {
  FrameGraph graph;
  graph.learn(link("base", "head", 0), false);
  graph.learn(link("base", "head", 1), false);
  SensorFrames frames(graph, "base", "");
  EXPECT_TRUE(frames.connected("head"));
  EXPECT_FALSE(frames.connected("moon"));
  EXPECT_TRUE(frames.at("moon", 0)->isApprox(Pose3::Identity(), 1e-12));
  EXPECT_TRUE(frames.opticalAt("moon", 0)->isApprox(opticalPose(), 1e-12));
  EXPECT_THAT(frames.warnings(), ElementsAre(HasSubstr("frame 'moon': no transform to 'base'")));
  const auto head = frames.at("head", 0);
  ASSERT_FALSE(head);
  EXPECT_EQ(head.reason(), "no transform from 'head' to 'base' at its time");
}

}  // namespace
}  // namespace roomgraph::bags
