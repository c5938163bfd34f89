// SPDX-License-Identifier: BSD-3-Clause
// Box2 against hand values and counted pixels.
#include "roomgraph/geometry/box.h"

#include <gtest/gtest.h>

#include "random_poses.h"

namespace roomgraph {
namespace {

TEST(Box2, HandComputed) {
  const Box2 a{0, 0, 4, 2}, b{2, 1, 6, 5};
  EXPECT_EQ(a.area(), 8);
  EXPECT_EQ(intersection(a, b), (Box2{2, 1, 4, 2}));
  EXPECT_DOUBLE_EQ(iou(a, b), 2.0 / (8 + 16 - 2));
  EXPECT_EQ(iou(a, a), 1);
  EXPECT_EQ(a.center(), Eigen::Vector2d(2, 1));
  EXPECT_DOUBLE_EQ((Box2{0, 0, 3, 4}).diagonal(), 5);
}

TEST(Box2, TouchingEmptyAndInvertedBoxesShareNothing) {
  const Box2 a{0, 0, 4, 2};
  EXPECT_EQ(intersection(a, {4, 0, 5, 2}), Box2{});
  EXPECT_EQ(iou(a, {4, 0, 5, 2}), 0);
  EXPECT_EQ(iou({}, {}), 0);
  EXPECT_EQ(iou(a, {1, 1, 1, 1}), 0);
  EXPECT_EQ((Box2{3, 0, 1, 2}).area(), 0);
  EXPECT_TRUE((Box2{3, 0, 1, 2}).empty());
}

TEST(Box2, ContainsIsHalfOpen) {
  const Box2 a{1, 1, 2, 2};
  EXPECT_TRUE(a.contains(1, 1));
  EXPECT_FALSE(a.contains(2, 1.5));
  EXPECT_FALSE(a.contains(1.5, 2));
}

TEST(Box2, Clipped) {
  EXPECT_EQ(clipped({-5, 10, 700, 500}, 640, 480), (Box2{0, 10, 640, 480}));
  EXPECT_TRUE(clipped({-5, -5, -1, -1}, 640, 480).empty());
}

TEST(Box2, IouEqualsCountedPixels) {
  test::Random random(3);
  for (int round = 0; round < 50; ++round) {
    const auto box = [&] {
      const double u = random.index(20), v = random.index(20);
      return Box2{u, v, u + random.index(15), v + random.index(15)};
    };
    const Box2 a = box(), b = box();
    int both = 0, any = 0;
    for (int u = 0; u < 40; ++u)
      for (int v = 0; v < 40; ++v) {
        both += a.contains(u, v) && b.contains(u, v);
        any += a.contains(u, v) || b.contains(u, v);
      }
    EXPECT_DOUBLE_EQ(iou(a, b), any > 0 ? double(both) / any : 0);
  }
}

}  // namespace
}  // namespace roomgraph
