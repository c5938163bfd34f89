// SPDX-License-Identifier: BSD-3-Clause
// Distance and offset from shape models against sampled points of their volume.
#include "roomgraph/geometry/shape_math.h"

#include <gtest/gtest.h>

#include <numbers>

#include "random_poses.h"

namespace roomgraph {
namespace {

ObjectShape anyShape(test::Random& random) {
  ObjectShape shape{static_cast<ShapeKind>(random.index(3)), random.uniform(0.3, 1.5),
                    random.uniform(0.3, 1.5), random.uniform(0.3, 1.5)};
  if (shape.kind == ShapeKind::kCylinder) shape.depth = shape.width;
  return shape;
}

// A random point of the model's volume (object frame), by the definition of ObjectShape.
Eigen::Vector3d pointInside(const ObjectShape& shape, test::Random& random) {
  const double z = random.uniform(0, shape.height);
  if (shape.kind != ShapeKind::kCylinder)
    return {random.uniform(-0.5, 0.5) * shape.depth, random.uniform(-0.5, 0.5) * shape.width, z};
  const double radius = shape.width / 2 * std::sqrt(random.uniform(0, 1));
  const double angle = random.uniform(-std::numbers::pi, std::numbers::pi);
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

// The foot point lies in the convex volume, and no other point of it lies on the offset's side of the plane
// through the foot point: so nothing of the volume is nearer.
TEST(ShapeMath, OffsetLeadsToTheNearestPoint) {
  int outside = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    test::Random random(seed);
    const ObjectShape shape = anyShape(random);
    const Eigen::Vector3d point = random.vector(1.5);
    const Eigen::Vector3d offset = offsetOutside<double>(shape.kind, sizeOf(shape), point);
    const Eigen::Vector3d foot = point - offset;
    EXPECT_GE(foot.z(), -1e-12);
    EXPECT_LE(foot.z(), shape.height + 1e-12);
    if (shape.kind == ShapeKind::kCylinder) {
      EXPECT_LE(foot.head<2>().norm(), shape.width / 2 + 1e-12);
    } else {
      EXPECT_LE(std::abs(foot.x()), shape.depth / 2 + 1e-12);
      EXPECT_LE(std::abs(foot.y()), shape.width / 2 + 1e-12);
    }
    if (offset.norm() > 0) {
      ++outside;
      for (int i = 0; i < 200; ++i)
        EXPECT_LE(offset.dot(pointInside(shape, random) - foot), 1e-12) << "seed " << seed;
    }
    const auto distance = distanceOutside<double>(shape.kind, sizeOf(shape), point);
    EXPECT_NEAR(distance[0], offset.head<2>().norm(), 1e-12) << "seed " << seed;
    EXPECT_NEAR(distance[1], std::abs(offset.z()), 1e-12) << "seed " << seed;
  }
  EXPECT_GT(outside, 100);
  EXPECT_LT(outside, 200);
}

TEST(ShapeMath, PointsInsideHaveNoDistance) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    test::Random random(seed);
    const ObjectShape shape = anyShape(random);
    const Eigen::Vector3d point = pointInside(shape, random);
    EXPECT_TRUE(offsetOutside<double>(shape.kind, sizeOf(shape), point).isZero(0)) << "seed " << seed;
    EXPECT_TRUE(distanceOutside(shape, point).isZero(0)) << "seed " << seed;
  }
}

}  // namespace
}  // namespace roomgraph
