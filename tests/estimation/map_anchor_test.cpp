// SPDX-License-Identifier: BSD-3-Clause
// MapAnchor: constellation confirmed by scan returns, and union of landmarks.
#include "roomgraph/estimation/map_anchor.h"

#include <gtest/gtest.h>

#include <cmath>

namespace roomgraph::test {
namespace {

Landmark chairOfMap(std::int64_t id, double x, double y) {
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

// A robot that stands at the origin, and its scan with returns at these places.
struct Standing {
  MotionSource none{MotionNoise{}, true};
  Motion motion{none, none, none};
  KeyPoses poses{motion};
  Standing() { poses.add(0, Pose3::Identity()); }
};

Scan scanWith(const std::vector<Eigen::Vector2d>& returns) {
  Scan scan;
  scan.angle_min_rad = 0;
  scan.angle_step_rad = 1e-3;
  scan.max_range_m = 30;
  for (int i = 0; i < 6283; ++i) {
    scan.ranges_m.push_back(0);
    scan.valid.push_back(false);
  }
  for (const auto& point : returns) {
    const double angle = std::atan2(point.y(), point.x());
    const auto beam = static_cast<std::size_t>(std::lround((angle < 0 ? angle + 2 * M_PI : angle) / 1e-3));
    scan.ranges_m[beam] = static_cast<float>(point.norm());
    scan.valid[beam] = true;
  }
  return scan;
}

TEST(MapAnchor, TheScanMustAgree) {
  const Standing robot;
  CSemanticMap map;
  map.landmarks = {chairOfMap(0, 0, 0), chairOfMap(1, 3, 0.5), chairOfMap(2, 1, -2.5)};
  map.occupancy = wall();
  const std::vector<Landmark> seen = {chairOfMap(5, -1, 0), chairOfMap(6, 2, 0.5),
                                      chairOfMap(7, 0, -2.5)};  // 1 m to the left
  MapAnchor anchor(map, {});
  EXPECT_FALSE(anchor.recognise(seen, robot.poses)) << "without a scan three objects are too few";
  anchor.add(scanWith({{0, 1}, {1, 1}, {2, 1}}));
  EXPECT_FALSE(anchor.recognise(seen, robot.poses)) << "returns in front of the wall";
  EXPECT_FALSE(anchor.recognised());
  anchor.add(scanWith({{0, 2}, {1, 2}, {2, 2}}));
  const auto found = anchor.recognise(seen, robot.poses);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->x, 1, 1e-9);
  EXPECT_NEAR(found->yaw, 0, 1e-9);
  EXPECT_TRUE(anchor.recognised());
  EXPECT_FALSE(anchor.recognise(seen, robot.poses)) << "a map is recognised once";
}

TEST(MapAnchor, JoinedKeepsWhatWasNotSeenAgain) {
  const auto all = joined({chairOfMap(4, 0, 0)}, {chairOfMap(4, 0.2, 0), chairOfMap(9, 5, 5)});
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[1].id.value, 5);
  EXPECT_EQ(all[1].position.x(), 5);
}

}  // namespace
}  // namespace roomgraph::test
