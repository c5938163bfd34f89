// SPDX-License-Identifier: BSD-3-Clause
// MapAnchor: constellation confirmed by scan returns, and union of landmarks.
#include "roomgraph/pipeline/map_anchor.h"

#include <gtest/gtest.h>

namespace roomgraph::testing {
namespace {

Landmark chairAt(std::int64_t id, double x, double y) {
  Landmark landmark;
  landmark.id = LandmarkId{id};
  landmark.class_name = "chair";
  landmark.shape = {ShapeKind::kCylinder, 0.6, 0.6, 0.9};
  landmark.position = {x, y, 0};
  return landmark;
}

// A wall along y = 2.
mrpt::maps::COccupancyGridMap2D::Ptr wall() {
  auto grid = mrpt::maps::COccupancyGridMap2D::Create(-4.f, 8.f, -4.f, 8.f, 0.05f);
  grid->fill(0.9f);
  for (double x = -4; x < 8; x += 0.05) grid->setPos(static_cast<float>(x), 2.f, 0.1f);
  return grid;
}

TEST(MapAnchor, ShareOfPointsOnWalls) {
  const auto grid = wall();
  EXPECT_DOUBLE_EQ(shareOnWalls(*grid, {{0, 2.05}, {1, 1.92}, {2, 1.5}, {3, 30}}), 0.5);
  EXPECT_DOUBLE_EQ(shareOnWalls(*grid, {}), 0);
}

TEST(MapAnchor, TheScanMustAgree) {
  CSemanticMap map;
  map.landmarks = {chairAt(0, 0, 0), chairAt(1, 3, 0.5), chairAt(2, 1, -2.5)};
  map.occupancy = wall();
  const MapAnchor anchor(map, {});
  const std::vector<Landmark> seen = {chairAt(5, -1, 0), chairAt(6, 2, 0.5),
                                      chairAt(7, 0, -2.5)};  // 1 m to the left
  const auto found = anchor.find(seen, {{0, 2}, {1, 2}, {2, 2}});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->x, 1, 1e-9);
  EXPECT_NEAR(found->yaw, 0, 1e-9);
  EXPECT_FALSE(anchor.find(seen, {{0, 1}, {1, 1}, {2, 1}})) << "returns in front of the wall";
  EXPECT_FALSE(anchor.find(seen, {})) << "without a scan three objects are too few";
}

TEST(MapAnchor, JoinedKeepsWhatWasNotSeenAgain) {
  const auto all = joined({chairAt(4, 0, 0)}, {chairAt(4, 0.2, 0), chairAt(9, 5, 5)});
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[1].id.value, 5);
  EXPECT_EQ(all[1].position.x(), 5);
}

}  // namespace
}  // namespace roomgraph::testing
