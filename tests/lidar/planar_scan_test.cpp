// SPDX-License-Identifier: BSD-3-Clause
// Planar scans: frame, range limits and thinning; submaps in the making and the filter of kept scans.
#include "planar_scan.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "active_submaps.h"
#include "submap_settings.h"

namespace roomgraph {
namespace {

/// Four beams at 0, 90, 180 and 270 degrees of a lidar that is turned by 90 degrees and mounted 0.3 m ahead.
Scan fourBeams() {
  Scan scan;
  scan.angle_min_rad = 0;
  scan.angle_step_rad = M_PI / 2;
  scan.ranges_m = {1, 2, 0.05f, 50};
  scan.valid = {1, 1, 1, 1};
  scan.robot_from_lidar = poseFromYpr(0.3, 0, 0.4, M_PI / 2, 0, 0);
  return scan;
}

TEST(PlanarScan, ReturnsAreInTheRobotFrameAndWithinTheLimits) {
  Scan scan = fourBeams();
  const PlanarScan planar = toPlanarScan(scan, 0.1, 30);
  EXPECT_EQ(planar.origin, Eigen::Vector2d(0.3, 0));
  ASSERT_EQ(planar.points.size(), 2u);
  EXPECT_LT((planar.points[0] - Eigen::Vector2d(0.3, 1)).norm(), 1e-9);
  EXPECT_LT((planar.points[1] - Eigen::Vector2d(-1.7, 0)).norm(), 1e-9);
  EXPECT_EQ(toPlanarScan(scan, 0.01, 100).points.size(), 4u);
  scan.valid[0] = 0;
  EXPECT_EQ(toPlanarScan(scan, 0.1, 30).points.size(), 1u);
}

TEST(PlanarScan, ThinningKeepsTheFirstPointOfEveryCell) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  Points2 points;
  for (int i = 0; i < 600; ++i) points.emplace_back(unit(random), unit(random));
  std::set<std::pair<int, int>> taken;
  Points2 expected;
  for (const auto& p : points)
    if (taken.emplace(static_cast<int>(std::floor(p.x() / 0.3)), static_cast<int>(std::floor(p.y() / 0.3))).second)
      expected.push_back(p);
  EXPECT_EQ(thinned(points, 0.3), expected);
  // The finest of 0.05, 0.07, 0.098 … that leaves at most 100.
  double cell = 0.05;
  while (thinned(points, cell).size() > 100) cell *= 1.4;
  EXPECT_EQ(thinnedTo(points, 0.05, 100), thinned(points, cell));
  EXPECT_EQ(thinnedTo(points, 0.05, 1000), thinned(points, 0.05));
}

TEST(PlanarScan, PointsAreTransformedOneByOne) {
  const Pose2 pose{0.5, -0.2, 0.7};
  const Points2 moved = transformed(pose, {{1, 2}, {-3, 0.5}});
  EXPECT_LT((moved[0] - pose * Eigen::Vector2d(1, 2)).norm(), 1e-12);
  EXPECT_LT((moved[1] - pose * Eigen::Vector2d(-3, 0.5)).norm(), 1e-12);
}

TEST(MotionFilter, AnyOfTimeDistanceAndTurnIsEnough) {
  const MotionFilter filter{0.2, 0.3, 5};
  const Pose2 last{1, 1, 3.1};
  EXPECT_FALSE(filter.moved(10, last, 14.9, {1.1, 1.1, 3.0}));
  EXPECT_TRUE(filter.moved(10, last, 15, last));
  EXPECT_TRUE(filter.moved(10, last, 11, {1.15, 1.15, 3.1}));
  EXPECT_FALSE(filter.moved(10, last, 11, {1, 1, -3.1})) << "a turn of 0.08 across pi";
  EXPECT_TRUE(filter.moved(10, last, 11, {1, 1, -2.87}));
  SubmapSettings settings;
  settings.keep_angle_rad = M_PI / 2;
  EXPECT_NEAR(settings.filter().angle_rad, M_PI / 2, 1e-12);
}

TEST(ActiveSubmaps, EveryScanIsInTwoThatOverlapByHalf) {
  const PlanarScan scan{{0.05, 0.05}, {{1.05, 0.05}}};
  ActiveSubmaps submaps(0.1, 10, {0.6, 0.4});
  EXPECT_EQ(submaps.oldest(), nullptr);
  std::vector<std::shared_ptr<Submap>> done;
  for (int i = 0; i < 33; ++i) {
    if (auto full = submaps.insert(scan, {0, 1.0 * i, 0})) done.push_back(full);
    ASSERT_NE(submaps.oldest(), nullptr);
    EXPECT_LT(submaps.oldest()->insertions, 10);
    // From the first overlap on, what is matched against has at least half a submap's scans.
    if (i >= 9) {
      EXPECT_GE(submaps.oldest()->insertions, 5) << i;
    }
  }
  ASSERT_EQ(done.size(), 5u);
  for (std::size_t k = 0; k < done.size(); ++k) {
    EXPECT_EQ(done[k]->first_insertion, static_cast<int>(5 * k));
    EXPECT_EQ(done[k]->insertions, 10);
    EXPECT_TRUE(done[k]->finished);
    for (int i = 0; i < 33; ++i) {  // scan i was at y = i
      const Eigen::Vector2i hit = done[k]->grid.cellOf({1.05, i + 0.05});
      EXPECT_EQ(done[k]->grid.known(hit.x(), hit.y()), i / 5 == static_cast<int>(k) || i / 5 == static_cast<int>(k) + 1);
    }
  }
}

TEST(ActiveSubmaps, AnInterruptedOneIsKeptWhenItHoldsHalf) {
  const PlanarScan scan{{0, 0}, {{1, 0}}};
  for (const int scans : {4, 5}) {
    ActiveSubmaps submaps(0.1, 10, {0.6, 0.4});
    for (int i = 0; i < scans; ++i) submaps.insert(scan, {});
    const auto rest = submaps.finishAll();
    EXPECT_EQ(rest != nullptr, scans == 5);
    if (rest) {
      EXPECT_TRUE(rest->finished);
    }
    EXPECT_EQ(submaps.oldest(), nullptr);
    submaps.insert(scan, {});
    EXPECT_EQ(submaps.oldest()->first_insertion, scans) << "numbers go on";
  }
}

}  // namespace
}  // namespace roomgraph
