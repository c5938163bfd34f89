// SPDX-License-Identifier: BSD-3-Clause
// Ground plane, local ground frame and ray intersection of random cameras.
#include "roomgraph/geometry/ground.h"

#include <gtest/gtest.h>

#include "random_poses.h"

namespace roomgraph {
namespace {

using test::Random;

// 0.8 m above the ground, looking along world x, pitched down.
Pose3 robotCamera(double pitch_down) {
  Pose3 pose = poseFromYpr(1, 2, 0.8, 0.3, pitch_down, 0);
  pose.linear() = pose.linear() * bodyFromOptical();
  return pose;
}

TEST(Plane, KeepsDistancesInAnotherFrame) {
  const Plane plane{Eigen::Vector3d(1, -2, 3).normalized(), 0.4};
  const Pose3 a_from_b = poseFromYpr(1, 2, 3, 0.4, -0.5, 0.6);
  const Plane moved = transformed(a_from_b, plane);
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, -1, 2)})
    EXPECT_NEAR(moved.distance(a_from_b * p), plane.distance(p), 1e-12);
}

TEST(Ground, PlaneOfAnyCamera) {
  Random random(1);
  for (int round = 0; round < 30; ++round) {
    const Pose3 world_from_camera = random.pose(3);
    const Plane ground = groundInCamera(world_from_camera);
    EXPECT_NEAR(ground.normal.norm(), 1, 1e-12);
    const Eigen::Vector3d p = random.vector(4);  // in the world
    EXPECT_NEAR(ground.distance(world_from_camera.inverse() * p), p.z(), 1e-9);
  }
}

TEST(Ground, LocalGroundFrame) {
  for (const double pitch : {0.0, 0.2, 0.9}) {
    const Pose3 world_from_camera = robotCamera(pitch);
    const Pose3 camera_from_ground = cameraFromGround(groundInCamera(world_from_camera));
    // By hand: below the camera, heading like the robot, level.
    EXPECT_TRUE((world_from_camera * camera_from_ground).isApprox(poseFromYpr(1, 2, 0, 0.3, 0, 0), 1e-9))
        << pitch;
  }
}

TEST(Ground, LocalGroundFrameLookingStraightDown) {
  const Pose3 frame = cameraFromGround({-Eigen::Vector3d::UnitZ(), 1.5});
  EXPECT_NEAR((frame.linear() * frame.linear().transpose() - Eigen::Matrix3d::Identity()).norm(), 0, 1e-12);
  EXPECT_NEAR(frame.linear().determinant(), 1, 1e-12);
  EXPECT_TRUE(frame.translation().isApprox(Eigen::Vector3d(0, 0, 1.5)));
}

TEST(Ground, RaysMeetThePlaneWhereTheyShould) {
  Random random(2);
  int met = 0;
  for (int round = 0; round < 200; ++round) {
    const Pose3 world_from_camera = robotCamera(random.uniform(-0.3, 0.8));
    const Eigen::Vector3d direction(random.uniform(-0.7, 0.7), random.uniform(-0.5, 0.5), 1);
    const auto point = intersect(direction, groundInCamera(world_from_camera));
    const Eigen::Vector3d in_world = world_from_camera.linear() * direction;
    ASSERT_EQ(point.has_value(), in_world.z() < -1e-9 * direction.norm()) << "only rays below the horizon";
    if (!point) continue;
    ++met;
    EXPECT_NEAR((world_from_camera * *point).z(), 0, 1e-9);
    EXPECT_LT(point->cross(direction).norm(), 1e-9 * point->norm() * direction.norm());
    EXPECT_GT(point->dot(direction), 0);
  }
  EXPECT_GT(met, 50);
  EXPECT_LT(met, 200);
}

TEST(Ground, ParallelRay) {
  EXPECT_FALSE(intersect({1, 0, 0}, {Eigen::Vector3d::UnitZ(), 1}).has_value());
}

}  // namespace
}  // namespace roomgraph
