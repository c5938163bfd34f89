// SPDX-License-Identifier: BSD-3-Clause
// Rays against objects (by marching along them), and picking in a map.
#include "roomgraph/viewer/picking.h"

#include <gtest/gtest.h>

#include <random>

#include "made_up_states.h"

namespace roomgraph::test {
namespace {

using Ray = OrbitCamera::Ray;

Eigen::Vector3d randomPoint(std::mt19937& random, double reach) {
  std::uniform_real_distribution<double> in(-reach, reach);
  return {in(random), in(random), in(random)};
}

TEST(Picking, ARayEntersWhereMarchingAlongItDoes) {
  std::mt19937 random(3);
  const Pose3 world_from_object = poseFromYpr(0.4, -0.3, 0.1, 0.7, 0, 0);
  int hits = 0;
  for (const ShapeKind kind : {ShapeKind::kCylinder, ShapeKind::kCuboid, ShapeKind::kPlanar}) {
    const ObjectShape shape{kind, 1.2, kind == ShapeKind::kCylinder ? 1.2 : 0.5, 0.9};
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector3d from = randomPoint(random, 3), towards = randomPoint(random, 1);
      const Ray ray(from, (towards - from).normalized());
      std::optional<double> entered;
      for (double s = 0; s < 8 && !entered; s += 0.002) {
        const Eigen::Vector3d at = world_from_object.inverse() * ray.pointAt(s);
        if (distanceOutside(shape, at).norm() == 0) entered = s;
      }
      const auto distance = distanceToObject(ray, shape, world_from_object);
      if (entered) {
        ++hits;
        ASSERT_TRUE(distance.has_value());
        EXPECT_NEAR(*distance, *entered, 0.003);
      } else if (distance) {  // it touches a corner between two steps
        const Eigen::Vector3d at = world_from_object.inverse() * ray.pointAt(*distance);
        EXPECT_LT(distanceOutside(shape, at).norm(), 0.003);
      }
    }
  }
  EXPECT_GT(hits, 100);
}

TEST(Picking, RaysThatRunAlongAnAxis) {
  const ObjectShape box{ShapeKind::kCuboid, 2, 1, 1}, drum{ShapeKind::kCylinder, 1, 1, 1};
  const Pose3 origin = Pose3::Identity();
  const Eigen::Vector3d down(0, 0, -1);
  for (const auto& shape : {box, drum}) {
    EXPECT_NEAR(*distanceToObject(Ray({0.2, 0.3, 5}, down), shape, origin), 4, 1e-12);
    EXPECT_FALSE(distanceToObject(Ray({0.6, 0, 5}, down), shape, origin)) << "beside it";
    EXPECT_FALSE(distanceToObject(Ray({0, 0, -5}, down), shape, origin)) << "behind the camera";
    EXPECT_EQ(distanceToObject(Ray({0, 0, 0.5}, down), shape, origin), 0) << "inside";
    EXPECT_FALSE(distanceToObject(Ray({-3, 0, 1.5}, {1, 0, 0}), shape, origin)) << "above it";
    EXPECT_NEAR(*distanceToObject(Ray({-3, 0, 0.5}, {1, 0, 0}), shape, origin), 2.5, 1e-12);
  }
  EXPECT_TRUE(distanceToObject(Ray({0, 0.9, 5}, down), box, origin)) << "two metres wide";
}

TEST(Picking, ThinThingsCanBeHitFromAbove) {
  const ObjectShape door{ShapeKind::kPlanar, 0.9, 0, 2};
  EXPECT_TRUE(distanceToObject(Ray({0.04, 0.3, 5}, {0, 0, -1}), door, Pose3::Identity()));
  EXPECT_FALSE(distanceToObject(Ray({0.06, 0.3, 5}, {0, 0, -1}), door, Pose3::Identity()));
}

TEST(Picking, TheNearestAndThoseOfTheMapFirst) {
  const ShownLandmarks landmarks{shownLandmark(sampleLandmark(1, "sofa", ShapeKind::kCuboid, 4, 0)),
                                 shownLandmark(sampleLandmark(2, "swivel_chair", ShapeKind::kCylinder, 2, 0)),
                                 shownLandmark(sampleLandmark(3, "sofa", ShapeKind::kCuboid, 1, 0), false),
                                 shownLandmark(sampleLandmark(4, "sofa", ShapeKind::kCuboid, 0, 3), false)};
  const Ray along({-5, 0, 0.5}, {1, 0, 0}), aside({-5, 3, 0.5}, {1, 0, 0}), away({-5, 9, 0.5}, {1, 0, 0});
  EXPECT_EQ(pickLandmark(along, landmarks, true).value, 2) << "the candidate before it is not believed";
  EXPECT_EQ(pickLandmark(aside, landmarks, true).value, 4);
  EXPECT_FALSE(pickLandmark(aside, landmarks, false).valid()) << "candidates are not shown";
  EXPECT_FALSE(pickLandmark(away, landmarks, true).valid());
}

}  // namespace
}  // namespace roomgraph::test
