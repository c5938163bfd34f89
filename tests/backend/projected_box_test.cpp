// SPDX-License-Identifier: BSD-3-Clause
// Templated box projection against projectShape and sampled surfaces.
#include "projected_box.h"

#include <gtest/gtest.h>

#include "object_residuals.h"
#include "object_views.h"
#include "roomgraph/geometry/projection.h"

namespace roomgraph::test {
namespace {

std::optional<std::array<double, 4>> sidesOf(const ObjectShape& shape, const Pose3& camera_from_object) {
  return projectedSides<double>(shape.kind, {shape.width, shape.depth, shape.height},
                                camera_from_object.linear(), camera_from_object.translation(), testCamera());
}

Pose3 viewOf(const ObjectShape& shape, double distance, Random& random) {
  const Eigen::Vector3d center(0, 0, shape.height / 2);
  return lookingAt(center + distance * random.direction(), center + random.vector(0.3), random.uniform(-3, 3))
      .inverse();
}

TEST(ProjectedBox, AgreesWithProjectShapeFarAndCutByTheNearPlane) {
  int compared = 0, cut = 0;
  for (unsigned seed = 1; seed <= 300; ++seed) {
    Random random(seed);
    const ObjectShape shape = randomShape(random);
    const Pose3 view = viewOf(shape, random.uniform(0.2, 5), random);
    const auto expected = projectShape(shape, view, testCamera());
    if (!expected) continue;
    const auto sides = sidesOf(shape, view);
    ASSERT_TRUE(sides) << "seed " << seed;
    const Box2& full = expected->full;
    const double wanted[] = {full.u_min, full.v_min, full.u_max, full.v_max};
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_NEAR((*sides)[i], wanted[i], 1e-8 * (1 + std::abs(wanted[i])))
          << "seed " << seed << " side " << i;
    ++compared;
    cut += view.translation().z() < shape.height ? 1 : 0;
  }
  EXPECT_GT(compared, 200);
  EXPECT_GT(cut, 20);
}

TEST(ProjectedBox, NothingBehindTheCamera) {
  const ObjectShape shape{ShapeKind::kCuboid, 1, 1, 1};
  Pose3 view = Pose3::Identity();
  view.translation() = Eigen::Vector3d(0, 0, -3);
  EXPECT_FALSE(sidesOf(shape, view));
}

// A random point of the model's surface, object frame.
Eigen::Vector3d surfacePoint(const ObjectShape& shape, Random& random) {
  const double z = random.index(2) == 0 ? random.uniform(0, shape.height) : shape.height * random.index(2);
  if (shape.kind == ShapeKind::kCylinder) {
    const double angle = random.uniform(-M_PI, M_PI);
    return {shape.radius() * std::cos(angle), shape.radius() * std::sin(angle), z};
  }
  // Corners are what bounds a box: every third point is on an upright edge.
  const double share = random.index(3) == 0 ? 0.5 : random.uniform(-0.5, 0.5), end = random.index(2) - 0.5;
  return random.index(2) == 0 ? Eigen::Vector3d(end * shape.depth, share * shape.width, z)
                              : Eigen::Vector3d(share * shape.depth, -end * shape.width, z);
}

TEST(ProjectedBox, BoundsSampledPointsOfTheSurfaceTightly) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    const ObjectShape shape = randomShape(random);
    const Pose3 view = viewOf(shape, random.uniform(3, 5), random);
    const auto sides = sidesOf(shape, view);
    ASSERT_TRUE(sides);
    Box2 sampled{1e9, 1e9, -1e9, -1e9};
    for (int i = 0; i < 20000; ++i) {
      const Eigen::Vector2d p = testCamera().project(view * surfacePoint(shape, random));
      sampled = {std::min(sampled.u_min, p.x()), std::min(sampled.v_min, p.y()),
                 std::max(sampled.u_max, p.x()), std::max(sampled.v_max, p.y())};
    }
    const double reached[] = {sampled.u_min, sampled.v_min, -sampled.u_max, -sampled.v_max};
    for (std::size_t i = 0; i < 4; ++i) {
      const double bound = i < 2 ? (*sides)[i] : -(*sides)[i];
      EXPECT_GE(reached[i], bound - 1e-9) << "seed " << seed << " side " << i;
      EXPECT_LT(reached[i], bound + 1) << "seed " << seed << " side " << i;  // px
    }
  }
}

TEST(ProjectedBox, SidesOnTheImageBorderAreNotCompared) {
  const std::array<bool, 4> cut = sidesInside({0, 100, 639.5, 200}, testCamera());
  EXPECT_EQ(cut, (std::array<bool, 4>{false, true, false, true}));
  EXPECT_EQ(sidesInside({5, 1, 600, 479}, testCamera()), (std::array<bool, 4>{true, false, true, false}));
}

TEST(DistanceFromModel, AgreesWithGeometry) {
  int outside = 0;
  for (unsigned seed = 1; seed <= 500; ++seed) {
    Random random(seed);
    const ObjectShape shape = randomShape(random);
    const Eigen::Vector3d point = random.vector(1.2);
    const auto ours = distanceFromModel<double>(shape.kind, {shape.width, shape.depth, shape.height}, point);
    const Eigen::Vector2d expected = distanceOutside(shape, point);
    EXPECT_NEAR(ours[0], expected[0], 1e-12) << "seed " << seed;
    EXPECT_NEAR(ours[1], expected[1], 1e-12) << "seed " << seed;
    outside += expected.norm() > 0 ? 1 : 0;
  }
  EXPECT_GT(outside, 100);
  EXPECT_LT(outside, 499);
}

}  // namespace
}  // namespace roomgraph::test
