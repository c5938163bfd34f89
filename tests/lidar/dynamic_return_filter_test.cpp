// SPDX-License-Identifier: BSD-3-Clause
// Removal of lidar returns in sectors around people.
#include "roomgraph/lidar/dynamic_return_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "synthetic_scans.h"

namespace roomgraph {
namespace {

Scan ringScan(int beams, float range_m) {
  Scan scan;
  scan.angle_min_rad = -M_PI;
  scan.angle_step_rad = 2 * M_PI / beams;
  scan.max_range_m = 10;
  scan.ranges_m.assign(static_cast<std::size_t>(beams), range_m);
  scan.valid.assign(static_cast<std::size_t>(beams), 1);
  return scan;
}

TEST(DynamicReturnFilter, RemovesExactlyTheSector) {
  Scan scan = ringScan(360, 2.f);
  // Beams -180 .. 179 deg: those at 10 .. 20 deg lie inside, ends included by half a degree of slack.
  const double deg = M_PI / 180;
  EXPECT_EQ(removeDynamicReturns(scan, {{9.5 * deg, 20.5 * deg, 1, 3}}), 11);
  for (int i = 0; i < 360; ++i)
    EXPECT_EQ(scan.valid[static_cast<std::size_t>(i)], !(i - 180 >= 10 && i - 180 <= 20)) << i;
}

TEST(DynamicReturnFilter, KeepsReturnsNearerAndFarther) {
  Scan scan = ringScan(360, 2.f);
  EXPECT_EQ(removeDynamicReturns(scan, {{-1, 1, 2.1, 3}, {-1, 1, 0.5, 1.9}}), 0);
}

TEST(DynamicReturnFilter, SectorAcrossTheBack) {
  Scan scan = ringScan(360, 2.f);
  const double deg = M_PI / 180;
  EXPECT_EQ(removeDynamicReturns(scan, {{175.5 * deg, -175.5 * deg, 1, 3}}), 9);
}

TEST(DynamicReturnFilter, CountsOverlapOnceAndSkipsInvalid) {
  Scan scan = ringScan(360, 2.f);
  scan.valid[185] = 0;
  const double deg = M_PI / 180;
  const DynamicWedge wedge{-0.5 * deg, 9.5 * deg, 1, 3};
  EXPECT_EQ(removeDynamicReturns(scan, {wedge, wedge}), 9);
}

TEST(DynamicReturnFilter, UsesTheRobotFrame) {
  Scan scan = ringScan(4, 2.f);  // beams at -180, -90, 0, 90 deg
  scan.robot_from_lidar = poseFromYpr(1, 0, 0.2, M_PI / 2, 0, 0);
  // The beam at 0 points along the robot's y axis from (1, 0): it ends at (1, 2).
  EXPECT_EQ(removeDynamicReturns(scan, {{std::atan2(2, 1) - 0.01, std::atan2(2, 1) + 0.01, 2.2, 2.3}}), 1);
  EXPECT_EQ(scan.valid[2], 0);
}

}  // namespace
}  // namespace roomgraph
