// SPDX-License-Identifier: BSD-3-Clause
// SubmapScanMatcher in simulated rooms: movement, wheel slip, corridor, loss.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>

#include "roomgraph/core/class_registry.h"
#include "roomgraph/lidar/register_classes.h"
#include "submap_scan_matcher.h"
#include "synthetic_scans.h"

namespace roomgraph {
namespace {

/// A way through the asymmetric room: 2.4 m forward in a bow, 6 cm and 1.7 degrees a scan.
std::vector<Pose2> bow() {
  std::vector<Pose2> poses{{-1, -0.5, 0}};
  for (int i = 0; i < 40; ++i) poses.push_back(poses.back() * Pose2{0.06, 0, 0.03});
  return poses;
}

struct Replayed {
  std::vector<ScanMatch> matches;
  Trajectory trajectory;
};

Replayed replay(const std::vector<test::Wall>& walls, const std::vector<Pose2>& poses, bool with_prior,
                const Pose2& odometry_error = {}) {
  std::mt19937 random(23);
  SubmapScanMatcher matcher;
  matcher.prepare();
  Replayed run;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    std::optional<Pose2> step;
    if (with_prior && i > 0) step = poses[i - 1].inverse() * poses[i] * odometry_error;
    run.matches.push_back(
        matcher.match(test::castScan(walls, poses[i], 0.1 * static_cast<double>(i), random), step));
  }
  run.trajectory = matcher.trajectory();
  return run;
}

void expectNear(const Pose2& found, const Pose2& truth, double tolerance_m, double tolerance_rad) {
  const Pose2 error = truth.inverse() * found;
  EXPECT_LT(std::hypot(error.x, error.y), tolerance_m);
  EXPECT_LT(std::abs(error.yaw), tolerance_rad);
}

TEST(SubmapScanMatcher, RecoversMovementWithPrior) {
  const auto poses = bow();
  // Odometry that is wrong by 1 cm and 1 degree in each step.
  const Replayed run = replay(test::asymmetricRoom(), poses, true, {0.01, 0, 0.017});
  for (const ScanMatch& m : run.matches) EXPECT_TRUE(m.matched) << m.reason;
  EXPECT_EQ(run.trajectory.size(), poses.size());
  expectNear(run.matches.back().odom_from_robot, poses.front().inverse() * poses.back(), 0.04, 0.02);
  EXPECT_GT(run.matches.back().score, 0.9);
}

TEST(SubmapScanMatcher, RecoversMovementWithoutPrior) {
  const auto poses = bow();
  const Replayed run = replay(test::asymmetricRoom(), poses, false);
  expectNear(run.matches.back().odom_from_robot, poses.front().inverse() * poses.back(), 0.04, 0.02);
}

// The wheels spin once, by more than the search window.
TEST(SubmapScanMatcher, ASlipOfTheWheelsDoesNotMoveTheScan) {
  const auto poses = bow();
  std::mt19937 random(23);
  SubmapScanMatcher matcher;
  matcher.prepare();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    std::optional<Pose2> step;
    if (i > 0) step = poses[i - 1].inverse() * poses[i];
    if (i == 20) step = *step * Pose2{0.45, 0, 0.25};
    const ScanMatch match = matcher.match(
        test::castScan(test::asymmetricRoom(), poses[i], 0.1 * static_cast<double>(i), random), step);
    ASSERT_TRUE(match.matched);
    expectNear(match.odom_from_robot, poses.front().inverse() * poses[i], 0.06, 0.03);
  }
}

// For a second, or for good, in which case wheels cannot lead on for ever.
TEST(SubmapScanMatcher, WheelsLeadOverABurstOfNoise) {
  const auto poses = bow();
  std::mt19937 random(23);
  std::normal_distribution<float> noise(0, 0.3F);
  SubmapScanMatcher matcher;
  matcher.prepare();
  int lasting = 0;
  for (std::size_t i = 0; i < poses.size() + 300; ++i) {
    const Pose2& here = poses[std::min(i, poses.size() - 1)];
    std::optional<Pose2> step;
    if (i > 0) step = poses[std::min(i, poses.size()) - 1].inverse() * here;
    Scan scan = test::castScan(test::asymmetricRoom(), here, 0.1 * static_cast<double>(i), random);
    const bool noisy = (i >= 15 && i < 25) || i >= poses.size();
    for (std::size_t k = 0; noisy && k < scan.ranges_m.size(); ++k) scan.ranges_m[k] = std::max(0.05F, scan.ranges_m[k] + noise(random));
    const ScanMatch match = matcher.match(scan, step);
    if (i < poses.size()) {
      EXPECT_EQ(match.matched, !noisy) << i << ' ' << match.reason;
      expectNear(match.odom_from_robot, poses.front().inverse() * here, 0.04, 0.02);
    }
    lasting += i >= poses.size() && !match.matched;
  }
  EXPECT_GT(lasting, 50);
  EXPECT_LT(lasting, 299);
  EXPECT_EQ(matcher.match(test::castScan(test::asymmetricRoom(), poses.back(), 100, random), Pose2{}).segment, 0);
}

TEST(SubmapScanMatcher, CorridorFollowsOdometryAndSaysItIsUncertain) {
  std::vector<Pose2> poses{{0, 0, 0}};
  for (int i = 0; i < 30; ++i) poses.push_back(poses.back() * Pose2{0.05, 0, 0});
  const Replayed run = replay(test::corridor(), poses, true);
  const ScanMatch& last = run.matches.back();
  ASSERT_TRUE(last.matched);
  EXPECT_NEAR(last.odom_from_robot.x, 1.5, 0.15);
  EXPECT_NEAR(last.odom_from_robot.y, 0, 0.025);  // half a cell
  EXPECT_GT(last.step_covariance(0, 0), 2 * last.step_covariance(1, 1));
}

// Shallow bays of a corridor tell little of how far it went: a step that slid is not to be the velocity of the next.
TEST(SubmapScanMatcher, CorridorWithoutOdometryGoesOnAsItWent) {
  auto walls = test::corridor();
  for (int bay = 0; bay < 3; ++bay) walls.push_back({{4.0 * bay + 1, 1.1}, {4.0 * bay + 1.9, 1.1}});
  std::mt19937 random(23);
  SubmapScanMatcher matcher;
  matcher.prepare();
  double before = 0;
  for (int i = 0; i < 160; ++i) {
    const double x = i < 20 ? 0 : 0.05 * (i - 20);  // stands, then goes
    Scan scan = test::castScan(walls, {x, 0, 0}, 0.1 * i, random, 0.01, 120);
    for (std::size_t k = 0; k < scan.ranges_m.size(); ++k)
      if (scan.ranges_m[k] > 3) scan.valid[k] = 0;
    const double found = matcher.match(scan, {}).odom_from_robot.x;
    EXPECT_LT(std::abs(found - before), 0.12) << i;
    EXPECT_NEAR(found, x, 0.5) << i;
    before = found;
  }
}

// The corridor stands still while the robot turns, so the uncertain direction turns in the robot's frame.
TEST(SubmapScanMatcher, CovarianceOfAStepIsInTheFrameOfTheRobotBeforeIt) {
  std::vector<Pose2> poses{{0, 0, 0}};
  for (int i = 0; i < 20; ++i) poses.push_back(poses.back() * Pose2{0, 0, 0.04});
  const Replayed run = replay(test::corridor(), poses, true);
  for (const std::size_t i : {5u, 12u, 20u}) {
    ASSERT_TRUE(run.matches[i].matched);
    const Eigen::Matrix2d covariance = run.matches[i].step_covariance.topLeftCorner<2, 2>();
    const double widest = 0.5 * std::atan2(2 * covariance(0, 1), covariance(0, 0) - covariance(1, 1));
    EXPECT_NEAR(widest, -poses[i - 1].yaw, 0.05) << i;
    const auto sigmas = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(covariance).eigenvalues();
    EXPECT_GT(sigmas[1], 2 * sigmas[0]) << "along the corridor against across it";
  }
}

TEST(SubmapScanMatcher, TooFewReturnsIsAReason) {
  SubmapScanMatcher matcher;
  matcher.prepare();
  Scan scan;
  scan.t = 1;
  scan.ranges_m = {1, 1, 1};
  scan.valid = {1, 1, 1};
  scan.angle_step_rad = 0.1;
  const ScanMatch match = matcher.match(scan, std::nullopt);
  EXPECT_FALSE(match.matched);
  EXPECT_EQ(match.reason, "too few returns");
  EXPECT_TRUE(matcher.trajectory().empty());
}

TEST(SubmapScanMatcher, RepeatedTimeIsAReason) {
  std::mt19937 random(1);
  SubmapScanMatcher matcher;
  matcher.prepare();
  const Scan scan = test::castScan(test::asymmetricRoom(), {}, 1, random);
  EXPECT_TRUE(matcher.match(scan, std::nullopt).matched);
  EXPECT_FALSE(matcher.match(scan, std::nullopt).matched);
}

TEST(SubmapScanMatcher, StartsANewSegmentSomewhereElse) {
  std::mt19937 random(1);
  SubmapScanMatcher matcher;
  matcher.prepare();
  for (int i = 0; i < 5; ++i)
    matcher.match(test::castScan(test::asymmetricRoom(), {}, i, random), Pose2{});
  const auto elsewhere = test::boxAt(-9, -9, 19, 17);
  ScanMatch match;
  for (int i = 5; i < 20 && match.segment == 0; ++i)
    match = matcher.match(test::castScan(elsewhere, {}, i, random), Pose2{});
  EXPECT_EQ(match.segment, 1);
  EXPECT_TRUE(match.matched);
  EXPECT_FALSE(match.anywhere) << "wheels told how it moved";
}

TEST(SubmapScanMatcher, WithoutAnyMovementANewSegmentMayBeAnywhere) {
  std::mt19937 random(1);
  SubmapScanMatcher matcher;
  matcher.prepare();
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(matcher.match(test::castScan(test::asymmetricRoom(), {}, i, random), std::nullopt).anywhere);
  ScanMatch match;
  for (int i = 5; i < 20 && match.segment == 0; ++i) match = matcher.match(test::castScan(test::boxAt(-9, -9, 19, 17), {}, i, random), std::nullopt);
  EXPECT_EQ(match.segment, 1);
  EXPECT_TRUE(match.anywhere);
}

// Covered while it is put down: the first scan after a pause has no return.
TEST(SubmapScanMatcher, AScanWithoutReturnsAfterAPauseDoesNotHideThatItWasCarried) {
  for (const bool wheels_go_on : {false, true}) {
    std::mt19937 random(3);
    SubmapScanMatcher matcher;
    for (int i = 0; i < 5; ++i) matcher.match(test::castScan(test::asymmetricRoom(), {}, 0.1 * i, random), Pose2{});
    Scan covered = test::castScan(test::asymmetricRoom(), {}, 3, random);
    covered.valid.assign(covered.valid.size(), 0);
    EXPECT_FALSE(matcher.match(covered, std::nullopt).matched);
    const auto prior = wheels_go_on ? std::optional(Pose2{}) : std::nullopt;
    const ScanMatch elsewhere = matcher.match(test::castScan(test::asymmetricRoom(), {1.2, 0.8, 2}, 3.1, random), prior);
    EXPECT_EQ(elsewhere.segment, 1);
    EXPECT_EQ(elsewhere.score, 1) << "its map begins there";
    EXPECT_TRUE(elsewhere.anywhere) << "what moved it before wheels told of it again";
    EXPECT_FALSE(matcher.match(test::castScan(test::asymmetricRoom(), {1.2, 0.8, 2}, 3.2, random), Pose2{}).anywhere);
  }
}

// After a pause, in which it may have been carried off.
TEST(SubmapScanMatcher, AfterAPauseItIsInTheSamePlaceOrBeginsANewSegment) {
  for (const double pause_s : {1.0, 3.0}) {
    std::mt19937 random(3);
    SubmapScanMatcher here, carried;
    for (int i = 0; i < 5; ++i) {
      const Scan scan = test::castScan(test::asymmetricRoom(), {0, 0, 0}, 0.1 * i, random);
      here.match(scan, Pose2{});
      carried.match(scan, Pose2{});
    }
    const ScanMatch same = here.match(test::castScan(test::asymmetricRoom(), {0.1, 0, 0.05}, pause_s, random), std::nullopt);
    EXPECT_TRUE(same.matched);
    EXPECT_EQ(same.segment, 0);
    EXPECT_GT(same.score, 0.8);
    EXPECT_FALSE(same.anywhere);
    const ScanMatch elsewhere = carried.match(test::castScan(test::asymmetricRoom(), {1.2, 0.8, 2}, pause_s, random), std::nullopt);
    EXPECT_EQ(elsewhere.segment, pause_s > 2 ? 1 : 0);
    if (pause_s > 2) {
      EXPECT_TRUE(elsewhere.matched) << "its map begins there";
      EXPECT_EQ(elsewhere.score, 1);
      EXPECT_TRUE(elsewhere.anywhere);
    }
    SubmapScanMatcher driving;
    for (int i = 0; i < 5; ++i) driving.match(test::castScan(test::asymmetricRoom(), {0, 0, 0}, 0.1 * i, random), Pose2{});
    const ScanMatch drove = driving.match(test::castScan(test::asymmetricRoom(), {1.2, 0.8, 2}, pause_s, random), Pose2{0.2, 0, 0});
    EXPECT_EQ(drove.segment, 0) << "something says how it moved";
  }
}

TEST(SubmapScanMatcher, SameInputSameOutput) {
  const auto poses = bow();
  const Replayed first = replay(test::asymmetricRoom(), poses, true),
                 second = replay(test::asymmetricRoom(), poses, true);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(first.matches[i].odom_from_robot.x, second.matches[i].odom_from_robot.x);
    EXPECT_EQ(first.matches[i].odom_from_robot.yaw, second.matches[i].odom_from_robot.yaw);
    EXPECT_EQ(first.matches[i].step_covariance, second.matches[i].step_covariance);
  }
}

TEST(LidarClasses, AreMadeByName) {
  lidar::registerClasses();
  EXPECT_TRUE(createStage<ScanMatcher>("SubmapScanMatcher", "test"));
  EXPECT_TRUE(createStage<ScanLoopCloser>("SubmapLoopCloser", "test"));
  EXPECT_THAT(implementationsOf(&ScanMatcher::GetRuntimeClassIdStatic()),
              ::testing::Contains("SubmapScanMatcher"));
}

}  // namespace
}  // namespace roomgraph
