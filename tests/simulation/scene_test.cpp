// SPDX-License-Identifier: BSD-3-Clause
// Scene: world frame, object poses and moving parts.
#include "scene.h"

#include <gtest/gtest.h>

#include "example_world.h"

namespace roomgraph {
namespace {

const SceneObject& only(const Scene& scene, const std::string& kind) {
  for (const auto& object : scene.objects())
    if (object.kind == kind) return object;
  throw std::out_of_range(kind);
}

TEST(Scene, TheWorldIsTheFirstPoseOfTheRobot) {
  const Scene scene(test::exampleWorld());
  EXPECT_LT((scene.worldFromRobot(0).matrix() - Eigen::Matrix4d::Identity()).norm(), 1e-9);
  EXPECT_LT((scene.worldFromRobot(1e6).translation() - Eigen::Vector3d(2, 0, 0)).norm(), 0.02);
  // The camera's optical axis points forward, its x axis to the right.
  const Pose3 camera = scene.worldFromCamera(0);
  EXPECT_LT((camera.translation() - Eigen::Vector3d(0.05, 0, 0.8)).norm(), 1e-9);
  EXPECT_LT((camera.linear().col(2) - Eigen::Vector3d::UnitX()).norm(), 1e-9);
  EXPECT_LT((camera.linear().col(0) + Eigen::Vector3d::UnitY()).norm(), 1e-9);
}

TEST(Scene, ObjectsAreWhereThePlanPutsThem) {
  const Scene scene(test::exampleWorld());
  const auto& block = only(scene, "block");
  EXPECT_LT((block.world_from_object.translation() - Eigen::Vector3d(3.5, 0.5, 0)).norm(), 1e-9);
  ASSERT_EQ(block.footprint.size(), 4u);
  Eigen::AlignedBox2d box;
  for (const auto& corner : block.footprint) box.extend(corner);
  EXPECT_LT((box.min() - Eigen::Vector2d(3.3, 0.2)).norm(), 1e-5);
  EXPECT_LT((box.max() - Eigen::Vector2d(3.7, 0.8)).norm(), 1e-5);
  const auto& door = only(scene, "door");
  EXPECT_EQ(door.class_name, "door");
  EXPECT_LT((door.world_from_object.translation() - Eigen::Vector3d(4, 2.06, 0)).norm(), 1e-9);
  EXPECT_EQ(door.size_wdh, Eigen::Vector3d(0.95, 0.12, 2.1));
  EXPECT_TRUE(only(scene, "person").moving);
}

TEST(Scene, OnlyPersonsMove) {
  const Scene scene(test::exampleWorld());
  const auto a = scene.partPoses(0), b = scene.partPoses(2);
  ASSERT_EQ(a.size(), scene.parts().size());
  for (std::size_t i = 0; i < a.size(); ++i)
    EXPECT_EQ((a[i].matrix() - b[i].matrix()).norm() > 0.1, scene.parts()[i].person >= 0) << i;
  EXPECT_NEAR(scene.persons(2)[0].second.x, 1.4, 1e-6);
}

TEST(Scene, AHandHeldCameraIsItsOwnRobot) {
  World world = test::exampleWorld();
  world.robot.reset();
  world.lidar.reset();
  world.odometry.reset();
  world.handheld =
      HandheldSpec{{{{1, 2, 1.4}, {4, 2, 0.5}}, {{2, 2, 1.3}, {4, 1, 0.8}}}, false, 0.3, "handheld"};
  const Scene scene(world);
  EXPECT_NEAR(scene.worldFromCamera(0).translation().z(), 1.4, 0.02);
  EXPECT_LT(scene.robotFromCamera().translation().norm(), 1e-9) << "a camera with a height is one on a robot";
  EXPECT_NEAR(scene.worldFromRobot(0).translation().head<2>().norm(), 0, 1e-9);
  EXPECT_NEAR(planarPart(scene.worldFromRobot(0)).yaw, 0, 1e-9);
  EXPECT_LT(scene.worldFromCamera(0).linear()(2, 2), -0.2);  // looks down
}

}  // namespace
}  // namespace roomgraph
