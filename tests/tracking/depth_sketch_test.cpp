// SPDX-License-Identifier: BSD-3-Clause
// Depth sketches: one place from two views, walls in each other's free space, what is left out.
#include "depth_sketch.h"

#include <gtest/gtest.h>

#include "textured_room.h"

namespace roomgraph::tracking {
namespace {

using test::TexturedRoom;

const TexturedRoom& room() {
  static const TexturedRoom one;
  return one;
}

DepthSketch sketchAt(const Pose3& world_from_camera) {
  return sketchDepth(room().render(0, world_from_camera), {});
}

TEST(DepthSketch, TwoViewsOfOnePlaceAgree) {
  const Pose3 first = poseFromYpr(0.6, 0.1, 0.2, 0, 0.5, 0), moved = poseFromYpr(0.3, 0, -0.2, 0, 0.4, 0.1);
  const DepthSketch a = sketchAt(first), b = sketchAt(first * moved);
  EXPECT_EQ(a.depth_mm.cols, 80);
  EXPECT_GT(agreement({{&a}}, {{&b}}, moved), 0.98);
  EXPECT_GT(agreement({{&b}}, {{&a}}, moved.inverse()), 0.98);
}

TEST(DepthSketch, WallsInFreeSpaceContradict) {
  const Pose3 first = poseFromYpr(0.6, 0.1, 0.2, 0, 0.5, 0);
  const DepthSketch a = sketchAt(first), b = sketchAt(first);
  EXPECT_LT(agreement({{&a}}, {{&b}}, poseFromYpr(0, 0, -0.8, 0, 0, 0)), 0.5) << "all of it nearer";
  EXPECT_LT(agreement({{&a}}, {{&b}}, poseFromYpr(0, 0, 0.8, 0, 0, 0)), 0.5)
      << "all of it behind: b sees through a's";
}

// A bare wall slides along itself unseen; what another view of the place shows round the corner does not.
TEST(DepthSketch, AnotherViewOfThePlaceTells) {
  const Pose3 ahead = Pose3::Identity(), aside = poseFromYpr(0, 0, 0, 0, 0.9, 0),
              slid = poseFromYpr(0.5, 0, 0, 0, 0, 0);
  const DepthSketch wall = sketchAt(ahead), corner = sketchAt(aside);
  EXPECT_GT(agreement({{&wall}}, {{&wall}}, slid), 0.95);
  EXPECT_LT(agreement({{&wall}, {&corner, aside}}, {{&wall}, {&corner, aside}}, slid), 0.9);
}

TEST(DepthSketch, WhatIsLeftOutOrUnknownHasNoVote) {
  Frame frame = room().render(0, Pose3::Identity());
  const DepthSketch before = sketchDepth(frame, {});
  frame.depth(cv::Rect(100, 40, 120, 160)) = 0.7f;
  const DepthSketch with = sketchDepth(frame, {}), without = sketchDepth(frame, {Box2{95, 35, 225, 205}});
  EXPECT_LT(agreement({{&before}}, {{&with}}, Pose3::Identity()), 0.9) << "somebody stands there";
  EXPECT_GT(agreement({{&before}}, {{&without}}, Pose3::Identity()), 0.99);
  frame.depth.setTo(0);
  const DepthSketch nothing = sketchDepth(frame, {});
  EXPECT_EQ(agreement({{&before}}, {{&nothing}}, Pose3::Identity()), 1);
}

}  // namespace
}  // namespace roomgraph::tracking
