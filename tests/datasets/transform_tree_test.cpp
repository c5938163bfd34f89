// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/datasets/transform_tree.h"

#include <gmock/gmock.h>

#include <stdexcept>

namespace roomgraph {
namespace {

using testing::HasSubstr;

/// world - robot (moving along x at 1 m/s from t = 10 to 12 s, turning by 90 degrees) - camera, lidar.
TransformTree makeTree(double horizon_s) {
  Trajectory moving;
  moving.add(10, poseFromYpr(0, 0, 0, 0, 0, 0));
  moving.add(12, poseFromYpr(2, 0, 0, M_PI / 2, 0, 0));
  TransformTree tree(horizon_s);
  tree.set("robot", "camera", poseFromYpr(0.1, 0, 0.8, 0, 0, 0));
  tree.set("robot", "lidar", poseFromYpr(0, 0, 0.3, M_PI, 0, 0));
  tree.set("world", "robot", moving);
  return tree;
}

TEST(TransformTree, InterpolatesAlongTheChain) {
  const auto tree = makeTree(0);
  const auto world_from_camera = tree.lookup("world", "camera", 11);
  ASSERT_TRUE(world_from_camera) << world_from_camera.reason();
  // Half way: robot at (1, 0), turned by 45 degrees; the camera is 0.1 m ahead of it.
  EXPECT_NEAR(world_from_camera->translation().x(), 1 + 0.1 * std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(world_from_camera->translation().y(), 0.1 * std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(world_from_camera->translation().z(), 0.8, 1e-12);
  const auto back = tree.lookup("camera", "world", 11);
  ASSERT_TRUE(back);
  EXPECT_TRUE((*back * *world_from_camera).isApprox(Pose3::Identity(), 1e-12));
}

TEST(TransformTree, BranchesMeetBelowTheMovingEdge) {
  // Lidar looks backwards: the camera, 0.1 m ahead of the robot, is 0.1 m behind it. Known at any time.
  const auto lidar_from_camera = makeTree(0).lookup("lidar", "camera", 1e6);
  ASSERT_TRUE(lidar_from_camera) << lidar_from_camera.reason();
  EXPECT_NEAR((lidar_from_camera->translation() - Eigen::Vector3d(-0.1, 0, 0.5)).norm(), 0, 1e-12);
  EXPECT_TRUE(makeTree(0).lookup("robot", "robot", 0));
}

TEST(TransformTree, RefusesBeyondTheHorizon) {
  const auto tree = makeTree(0.5);
  const auto near = tree.lookup("world", "robot", 12.4);
  ASSERT_TRUE(near);
  EXPECT_NEAR(near->translation().x(), 2.4, 1e-12);
  const auto late = tree.lookup("world", "camera", 12.6);
  EXPECT_FALSE(late);
  EXPECT_THAT(late.reason(), HasSubstr("'world' from 'robot'"));
  EXPECT_THAT(late.reason(), HasSubstr("0.600 s after the last pose"));
  EXPECT_THAT(tree.lookup("world", "robot", 9).reason(), HasSubstr("1.000 s before the first pose"));
}

TEST(TransformTree, NamesWhatIsMissing) {
  auto tree = makeTree(0);
  EXPECT_THAT(tree.lookup("world", "gripper", 11).reason(), HasSubstr("unknown frame 'gripper'"));
  tree.set("dock", "charger", Pose3::Identity());
  EXPECT_THAT(tree.lookup("world", "charger", 11).reason(), HasSubstr("not connected"));
  Trajectory parts;
  parts.add(1, Pose3::Identity(), 0);
  parts.add(2, Pose3::Identity(), 1);
  tree.set("world", "ball", parts);
  EXPECT_THAT(tree.lookup("world", "ball", 1.5).reason(), HasSubstr("between two segments"));
  tree.set("world", "ball", Trajectory());
  EXPECT_THAT(tree.lookup("world", "ball", 1.5).reason(), HasSubstr("no pose"));
}

TEST(TransformTree, RefusesLoopsAndSecondParents) {
  auto tree = makeTree(0);
  EXPECT_THROW(tree.set("camera", "world", Pose3::Identity()), std::invalid_argument);
  EXPECT_THROW(tree.set("world", "camera", Pose3::Identity()), std::invalid_argument);
  EXPECT_THROW(tree.set("robot", "robot", Pose3::Identity()), std::invalid_argument);
  tree.set("robot", "camera", Pose3::Identity());  // replacing is allowed
  EXPECT_TRUE(tree.lookup("robot", "camera", 0)->isApprox(Pose3::Identity()));
}

}  // namespace
}  // namespace roomgraph
