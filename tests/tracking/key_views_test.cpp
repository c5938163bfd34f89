// SPDX-License-Identifier: BSD-3-Clause
// Key views: found again from nearby, not in another room, and kept few.
#include "roomgraph/tracking/key_views.h"

#include <gtest/gtest.h>

#include "textured_room.h"

namespace roomgraph {
namespace {

Pose3 turned(double yaw, double x = 0) {
  Pose3 pose = Pose3::Identity();
  pose.linear() = expSO3({0, yaw, 0});
  pose.translation() << x, 0, 0;
  return pose;
}

std::vector<KeyView> viewsOf(const test::TexturedRoom& room) {
  std::vector<KeyView> views;
  for (int i = 0; i < 8; ++i) {
    views.push_back(makeKeyView(room.render(i, turned(0.8 * i)), {}, 200));
    views.back().world_from_camera = turned(0.8 * i);
  }
  return views;
}

TEST(KeyViews, TellWhereACameraIs) {
  const test::TexturedRoom room;
  const auto views = viewsOf(room);
  EXPECT_LE(views[0].corners.size(), 200u);
  const ViewLocator locator(views);
  const Pose3 truth = turned(1.75, 0.2);
  const auto found = locator.locate(room.render(99, truth), {});
  ASSERT_TRUE(found);
  const Pose3 error = truth.inverse() * found->world_from_camera;
  EXPECT_LT(error.translation().norm(), 0.03);
  EXPECT_LT(rotationAngle(error), 0.02);
}

TEST(KeyViews, OfAnotherRoomTellNothing) {
  const ViewLocator locator(viewsOf(test::TexturedRoom(1)));
  const test::TexturedRoom other(2);
  for (int i = 0; i < 8; ++i) EXPECT_FALSE(locator.locate(other.render(i, turned(0.8 * i)), {})) << i;
  EXPECT_FALSE(ViewLocator({}).locate(other.render(0, turned(0)), {}));
}

TEST(KeyViews, ViewsWhoseCornersDisagreeTellNothing) {
  const test::TexturedRoom room;
  auto views = viewsOf(room);
  views.push_back(views[2]);
  views.back().world_from_camera = turned(1.6, 5);  // the same picture in two places
  EXPECT_FALSE(ViewLocator(views).locate(room.render(99, turned(1.6)), {}));
}

TEST(KeyViews, ThinningKeepsTheLatestAndTheirNumberBounded) {
  std::vector<KeyView> views(60);
  for (int i = 0; i < 60; ++i) {
    views[static_cast<std::size_t>(i)].t = i;
    views[static_cast<std::size_t>(i)].world_from_camera = turned(0, 0.5 * (i % 30));  // the way twice
  }
  const auto kept = thinnedViews(views, 100, 0.4, 1);
  ASSERT_EQ(kept.size(), 30u);
  EXPECT_EQ(kept.front().t, 30);
  const auto few = thinnedViews(views, 7, 0.4, 1);
  EXPECT_LE(few.size(), 7u);
  EXPECT_GE(few.size(), 4u);
  EXPECT_TRUE(thinnedViews(views, 0, 0.4, 1).empty());
}

}  // namespace
}  // namespace roomgraph
