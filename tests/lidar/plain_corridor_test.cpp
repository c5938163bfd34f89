// SPDX-License-Identifier: BSD-3-Clause
// Between two plain walls, and where there are no returns: what scans do not know, they must not claim.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <random>

#include "submap_loop_closer.h"
#include "submap_scan_matcher.h"
#include "surface_refinement.h"
#include "synthetic_scans.h"

namespace roomgraph {
namespace {

// Wheels with 1 % of noise, 5 cm a scan, along the corridor; the frame of the odometry begins turned by `heading`.
double lengthDriven(double heading, double sigma_m, int scans) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.01);
  SubmapScanMatcher matcher;
  matcher.prepare();
  ScanMatch last;
  for (int i = 0; i < scans; ++i) {
    Scan scan = test::castScan(test::corridor(), {0.05 * i, 0, 0}, 0.1 * i, random, sigma_m);
    scan.robot_from_lidar = poseFromYpr(0, 0, 0, heading, 0, 0);
    std::optional<Pose2> step;
    const Pose2 turned{0, 0, heading};
    if (i > 0) step = turned * Pose2{0.05 * (1 + noise(random)), 0, 0} * turned.inverse();
    last = matcher.match(scan, step);
    EXPECT_TRUE(last.matched) << i;
  }
  return std::hypot(last.odom_from_robot.x, last.odom_from_robot.y);
}

TEST(PlainCorridor, IsAsLongAsTheWheelsSay) {
  for (const double heading : {0.0, M_PI / 4})
    for (const double sigma_m : {0.0, 0.01, 0.03})
      EXPECT_NEAR(lengthDriven(heading, sigma_m, 301), 15, 0.1) << heading << " " << sigma_m;
}

TEST(PlainCorridor, TheScatterOfNormalsIsNoInformationAlongIt) {
  for (const double sigma_m : {0.01, 0.03}) {
    std::mt19937 random(6);
    LocalSurfaces surfaces(0.05);
    for (int i = 0; i < 20; ++i) {
      const PlanarScan scan = toPlanarScan(test::castScan(test::corridor(), {0.1 * i, 0, 0}, 0, random, sigma_m), 0.1, 30);
      surfaces.insert(transformed(Pose2{0.1 * i, 0, 0}, faced(scan)));
    }
    const PlanarScan scan = toPlanarScan(test::castScan(test::corridor(), {1, 0, 0}, 0, random, sigma_m), 0.1, 30);
    GridRefinement start;
    start.grid_from_scan = {1, 0, 0};
    const auto fit = refineOnSurfaces(surfaces, faced(scan), start, {});
    ASSERT_TRUE(fit);
    EXPECT_LT(fit->information(0, 0), 1 / (0.15 * 0.15)) << sigma_m;
    EXPECT_GT(fit->information(1, 1), 1 / (0.01 * 0.01)) << sigma_m;
  }
}

// To and fro without an end in sight, once with what was driven since some centimetres too long: scans fit anywhere along the walls.
TEST(PlainCorridor, ClosesNoLoop) {
  const auto placeAt = [](int i) { return 0.1 * (i % 200 < 100 ? i % 100 : 100 - i % 100); };
  for (const auto& [sigma_m, drift] : {std::pair{0.01, 2e-4}, {0.02, 2e-4}, {0.02, 2e-3}}) {
    std::mt19937 random(7);
    SubmapLoopCloser closer;
    closer.prepare();
    Trajectory world;
    std::size_t closures = 0;
    for (int i = 0; i < 400; ++i) {
      ScanMatch match;
      match.matched = true;
      match.odom_from_robot = {placeAt(i) + drift * i, 0, 0};
      world.add(0.2 * i, toPose3(match.odom_from_robot));
      Scan scan = test::castScan(test::corridor(), {placeAt(i), 0, 0}, 0.2 * i, random, sigma_m);
      for (std::size_t beam = 0; beam < scan.ranges_m.size(); ++beam) scan.valid[beam] = scan.valid[beam] && scan.ranges_m[beam] < 8;
      closer.add(scan, match);
      closures += closer.search([&](double at) { return world.at(at); }).size();
    }
    EXPECT_EQ(closures, 0u) << sigma_m << " " << drift;
  }
}

// Scans every .6 s and nothing else: the robot goes on between them, and turns by more than a search at ten a second reaches.
TEST(SlowLidar, GoesOnBetweenItsScans) {
  std::mt19937 random(9);
  SubmapScanMatcher matcher;
  matcher.prepare();
  const auto poseAt = [](int i) {
    const double turn = i < 3 ? 0 : 0.6 + 0.9 * (i - 3);  // from rest by .6 rad, then by .9 each time
    return Pose2{0.8 + 0.4 * std::cos(turn), 0.3 + 0.4 * std::sin(turn), wrapAngle(turn + M_PI / 2)};
  };
  for (int i = 0; i < 25; ++i) {
    const ScanMatch match = matcher.match(test::castScan(test::asymmetricRoom(), poseAt(i), 0.6 * i, random), std::nullopt);
    ASSERT_TRUE(match.matched) << i;
    const Pose2 error = (poseAt(0).inverse() * poseAt(i)).inverse() * match.odom_from_robot;
    ASSERT_LT(std::hypot(error.x, error.y), 0.03) << i;
    ASSERT_LT(std::abs(error.yaw), 0.01) << i;
  }
}

// A hand before the lidar, a hall wider than it reaches: the search for the next scan must not grow with each that is missed.
TEST(Blindness, HoweverLongTheNextScanIsFoundInAMoment) {
  for (const bool with_wheels : {true, false}) {
    std::mt19937 random(8);
    SubmapScanMatcher matcher;
    matcher.prepare();
    const auto room = test::asymmetricRoom();
    const std::optional<Pose2> step = with_wheels ? std::optional(Pose2{}) : std::nullopt;
    for (int i = 0; i < 20; ++i) matcher.match(test::castScan(room, {}, 0.1 * i, random), i > 0 ? step : std::nullopt);
    Scan blind = test::castScan(room, {}, 0, random);
    std::fill(blind.valid.begin(), blind.valid.end(), char{0});
    for (int i = 20; i < 1000; ++i) {
      blind.t = 0.1 * i;
      EXPECT_FALSE(matcher.match(blind, step).matched);
    }
    const auto begun = std::chrono::steady_clock::now();
    const ScanMatch found = matcher.match(test::castScan(room, {}, 100, random), step);
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count(), 5) << with_wheels;
    EXPECT_TRUE(found.matched);
    if (with_wheels) {
      EXPECT_LT(std::hypot(found.odom_from_robot.x, found.odom_from_robot.y), 0.02);
    }
  }
}

}  // namespace
}  // namespace roomgraph
