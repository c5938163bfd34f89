// SPDX-License-Identifier: BSD-3-Clause
// Shape names, footprints and distances from the volume.
#include "roomgraph/geometry/shape.h"

#include <gtest/gtest.h>

#include <numbers>

namespace roomgraph {
namespace {

TEST(Shape, NamesRoundTrip) {
  for (const auto kind : {ShapeKind::kCylinder, ShapeKind::kCuboid, ShapeKind::kPlanar})
    EXPECT_EQ(shapeKindFromString(toString(kind)), kind);
  EXPECT_THROW(shapeKindFromString("sphere"), std::invalid_argument);
}

TEST(Shape, FootprintsAreCounterClockwise) {
  const ObjectShape cuboid{ShapeKind::kCuboid, 2, 1, 0.5};
  EXPECT_DOUBLE_EQ(polygonArea(footprint(cuboid)), 2);
  for (const auto& corner : footprint(cuboid)) {
    EXPECT_EQ(std::abs(corner.x()), 0.5) << "depth is along x";
    EXPECT_EQ(std::abs(corner.y()), 1.0) << "width is along y";
  }
  const ObjectShape cylinder{ShapeKind::kCylinder, 0.6, 0.6, 1};
  EXPECT_NEAR(polygonArea(footprint(cylinder, 500)), std::numbers::pi * 0.09, 1e-4);
  EXPECT_LT(polygonArea(footprint(cylinder, 8)), std::numbers::pi * 0.09);
}

TEST(Shape, FootprintTurnsWithItsPose) {
  const ObjectShape cuboid{ShapeKind::kCuboid, 2, 1,
                           0.5};  // its front, half its depth ahead, shows to the left
  const auto corners = footprintAt({3, 4, std::numbers::pi / 2}, cuboid);
  Eigen::AlignedBox2d box;
  for (const auto& corner : corners) box.extend(corner);
  EXPECT_TRUE(box.min().isApprox(Eigen::Vector2d(2, 3.5))) << box.min().transpose();
  EXPECT_TRUE(box.max().isApprox(Eigen::Vector2d(4, 4.5))) << box.max().transpose();
  EXPECT_NEAR(polygonArea(corners), 2, 1e-12) << "counter-clockwise";
}

TEST(Shape, DistanceOutside) {
  const ObjectShape cuboid{ShapeKind::kCuboid, 2, 1, 0.5};
  EXPECT_EQ(distanceOutside(cuboid, {0, 0, 0.2}), Eigen::Vector2d(0, 0));
  EXPECT_EQ(distanceOutside(cuboid, {3.5, 5, 1}), Eigen::Vector2d(5, 0.5));
  EXPECT_EQ(distanceOutside(cuboid, {0, 0, -0.25}), Eigen::Vector2d(0, 0.25));
  const ObjectShape cylinder{ShapeKind::kCylinder, 2, 2, 1};
  EXPECT_EQ(distanceOutside(cylinder, {3, 4, 0.5}), Eigen::Vector2d(4, 0));
  EXPECT_EQ(distanceOutside(cylinder, {0.5, 0.5, 3}), Eigen::Vector2d(0, 2));
}

}  // namespace
}  // namespace roomgraph
