// SPDX-License-Identifier: BSD-3-Clause
// 3D IoU against closed forms and Monte Carlo sampling.
#include <gtest/gtest.h>

#include <numbers>

#include "random_poses.h"
#include "roomgraph/geometry/shape.h"

namespace roomgraph {
namespace {

using test::Random;

Pose3 upright(double x, double y, double z, double yaw) {
  return poseFromYpr(x, y, z, yaw, 0, 0);
}

// Share of random points that lie in both, of those that lie in any.
double sampledIou(const ObjectShape& a, const Pose3& world_from_a, const ObjectShape& b,
                  const Pose3& world_from_b, Random& random) {
  int both = 0, any = 0;
  const auto inside = [](const ObjectShape& shape, const Eigen::Vector3d& p) {
    return distanceOutside(shape, p).isZero();
  };
  const Pose3 a_from_world = world_from_a.inverse(), b_from_world = world_from_b.inverse();
  for (int i = 0; i < 300000; ++i) {
    const double x = random.uniform(-1.5, 1.5), y = random.uniform(-1.5, 1.5);
    const Eigen::Vector3d p(x, y, random.uniform(-0.3, 1.5));
    const bool in_a = inside(a, a_from_world * p), in_b = inside(b, b_from_world * p);
    both += in_a && in_b;
    any += in_a || in_b;
  }
  return double(both) / any;
}

TEST(Iou3d, ClosedForms) {
  const ObjectShape box{ShapeKind::kCuboid, 2, 1, 1};
  const Pose3 home = upright(0, 0, 0, 0);
  EXPECT_NEAR(iou3d(box, home, box, home), 1, 1e-12);
  EXPECT_NEAR(iou3d(box, home, box, upright(0, 0, 0, std::numbers::pi)), 1, 1e-9);
  EXPECT_NEAR(iou3d(box, home, box, upright(0, 0, 0, std::numbers::pi / 2)), 1.0 / 3, 1e-9);
  EXPECT_NEAR(iou3d(box, home, box, upright(0, 1, 0, 0)), 1.0 / 3, 1e-9);
  EXPECT_NEAR(iou3d(box, home, box, upright(0, 0, 0.5, 0)), 1.0 / 3, 1e-9);
  EXPECT_EQ(iou3d(box, home, box, upright(5, 0, 0, 0)), 0);
  EXPECT_EQ(iou3d(box, home, box, upright(0, 0, 1.5, 0)), 0) << "one above the other";
  EXPECT_EQ(iou3d(box, home, box, upright(0, 0, 1, 0)), 0);
  // Two squares turned by 45 deg share a regular octagon: area 2 (sqrt 2 - 1) of a unit square.
  const ObjectShape cube{ShapeKind::kCuboid, 1, 1, 1};
  const double octagon = 2 * (std::sqrt(2.0) - 1);
  EXPECT_NEAR(iou3d(cube, home, cube, upright(0, 0, 0, std::numbers::pi / 4)), octagon / (2 - octagon), 1e-9);
}

TEST(Iou3d, ThinDoorsGetAThickness) {
  const ObjectShape door{ShapeKind::kPlanar, 1, 0.0, 2};
  EXPECT_NEAR(iou3d(door, upright(0, 0, 0, 0), door, upright(0.05, 0, 0, 0)), 1.0 / 3, 1e-9);
}

TEST(Iou3d, CylinderLens) {
  const ObjectShape round{ShapeKind::kCylinder, 1, 1, 1};
  const double r = 0.5, d = 0.4;
  const double lens = 2 * r * r * std::acos(d / (2 * r)) - d / 2 * std::sqrt(4 * r * r - d * d);
  const double expected = lens / (2 * std::numbers::pi * r * r - lens);
  EXPECT_NEAR(iou3d(round, upright(0, 0, 0, 0), round, upright(d, 0, 0, 1)), expected, 5e-3);
}

TEST(Iou3d, EqualsSampling) {
  Random random(9);
  for (int round = 0; round < 12; ++round) {
    const auto shape = [&] {
      const double width = random.uniform(0.6, 1.6);
      const bool cylinder = random.index(2) == 0;
      const double depth = cylinder ? width : random.uniform(0.6, 1.6);
      return ObjectShape{cylinder ? ShapeKind::kCylinder : ShapeKind::kCuboid, width, depth,
                         random.uniform(0.5, 1.2)};
    };
    const auto pose = [&] {
      const double x = random.uniform(-0.3, 0.3), y = random.uniform(-0.3, 0.3),
                   z = random.uniform(-0.3, 0.3);
      return upright(x, y, z, random.uniform(-3, 3));
    };
    const ObjectShape a = shape(), b = shape();
    const Pose3 world_from_a = pose(), world_from_b = pose();
    const double sampled = sampledIou(a, world_from_a, b, world_from_b, random);
    EXPECT_NEAR(iou3d(a, world_from_a, b, world_from_b), sampled, 0.015);
    EXPECT_NEAR(iou3d(a, world_from_a, b, world_from_b), iou3d(b, world_from_b, a, world_from_a), 1e-9);
  }
}

TEST(IntersectConvex, HandComputed) {
  const std::vector<Eigen::Vector2d> square = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};
  const std::vector<Eigen::Vector2d> triangle = {{1, 1}, {4, 1}, {1, 4}};
  EXPECT_NEAR(polygonArea(intersectConvex(square, triangle)), 1, 1e-12);
  EXPECT_NEAR(polygonArea(intersectConvex(square, {{0, 0}, {1, 0}, {0, 1}})), 0.5, 1e-12);
  EXPECT_EQ(polygonArea(intersectConvex(square, {{5, 5}, {6, 5}, {5, 6}})), 0);
}

}  // namespace
}  // namespace roomgraph
