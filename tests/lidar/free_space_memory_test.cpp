// SPDX-License-Identifier: BSD-3-Clause
// Returns that contradict free space: walkers, new walls, pose errors, doors that close, jumps of the pose.
#include "roomgraph/lidar/free_space_memory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "roomgraph/core/config.h"
#include "submap_scan_matcher.h"
#include "synthetic_scans.h"

namespace roomgraph {
namespace {

using test::Wall;

constexpr double kPersonRadius_m = 0.2, kScanStep_s = 0.1;

std::vector<Wall> with(std::vector<Wall> walls, const std::vector<Wall>& more) {
  walls.insert(walls.end(), more.begin(), more.end());
  return walls;
}

std::vector<Wall> personAt(const Eigen::Vector2d& place) {
  std::vector<Eigen::Vector2d> corners;
  for (int i = 0; i < 12; ++i)
    corners.emplace_back(place +
                         kPersonRadius_m * Eigen::Vector2d(std::cos(i * M_PI / 6), std::sin(i * M_PI / 6)));
  return test::ring(corners);
}

/// Returns of one scan or of many, and how many of them were said to be moving.
struct Share {
  int returns = 0, moving = 0;
  double value() const { return returns ? static_cast<double>(moving) / returns : 0; }
};

/// A robot that looks round ten times a second, and what it said of the returns near a place and of all
/// others.
struct Watch {
  FreeSpaceMemory memory;
  std::mt19937 random{11};
  double t = 0;
  int beams = 720;
  double pose_sigma_m = 0, pose_sigma_rad = 0;
  Share near, elsewhere;

  void look(const std::vector<Wall>& walls, const Pose2& pose, const Eigen::Vector2d& place = {1e3, 1e3}) {
    const Scan scan = test::castScan(walls, pose, t, random, 0.01, beams);
    t += kScanStep_s;
    std::normal_distribution<double> noise;
    const Pose2 believed = pose * Pose2{pose_sigma_m * noise(random), pose_sigma_m * noise(random),
                                        pose_sigma_rad * noise(random)};
    const auto moving = memory.observe(scan, believed);
    EXPECT_TRUE(std::is_sorted(moving.begin(), moving.end()));
    for (std::size_t i = 0; i < scan.valid.size(); ++i) {
      if (!scan.valid[i]) continue;
      const double angle = scan.angle_min_rad + static_cast<double>(i) * scan.angle_step_rad;
      const auto range = static_cast<double>(scan.ranges_m[i]);
      const Eigen::Vector2d point = pose * Eigen::Vector2d(range * std::cos(angle), range * std::sin(angle));
      Share& share = (point - place).norm() < kPersonRadius_m + 0.05 ? near : elsewhere;
      ++share.returns;
      share.moving += std::binary_search(moving.begin(), moving.end(), i);
    }
  }
  void lookFor(double seconds, const std::vector<Wall>& walls, const Pose2& pose,
               const Eigen::Vector2d& place = {1e3, 1e3}) {
    for (int i = 0; i < std::lround(seconds / kScanStep_s); ++i) look(walls, pose, place);
  }
  /// Somebody goes in a straight line at 1 m/s.
  void walk(const std::vector<Wall>& walls, const Pose2& pose, const Eigen::Vector2d& from,
            const Eigen::Vector2d& to) {
    const int steps = static_cast<int>(std::ceil((to - from).norm() / kScanStep_s));
    for (int i = 0; i <= steps; ++i) {
      const Eigen::Vector2d place = from + (to - from) * i / steps;
      look(with(walls, personAt(place)), pose, place);
    }
  }
  void forget() { near = elsewhere = {}; }
};

const Pose2 kStand{0.5, 0.3, 0.2};

TEST(FreeSpaceMemory, WhoeverWalksBehindTheRobotIsMoving) {
  Watch watch;
  const auto room = test::asymmetricRoom();
  watch.lookFor(3, room, kStand);
  EXPECT_EQ(watch.elsewhere.moving, 0);
  watch.walk(room, kStand, {-2.2, -1.2}, {-0.6, 1.2});
  EXPECT_GT(watch.near.returns, 500);
  EXPECT_GT(watch.near.value(), 0.97);
  EXPECT_LT(watch.elsewhere.value(), 0.0005);
}

// Beams of a depth image that saw the floor so far, and nothing on it.
TEST(FreeSpaceMemory, BeamsWithoutReturnFreeSpaceAsFarAsTheyAreKnownToHaveGone) {
  for (const float free_m : {0.F, 1.5F, 4.F}) {
    FreeSpaceMemory memory;
    Scan scan;
    scan.angle_min_rad = -0.5;
    scan.angle_step_rad = 0.01;
    scan.ranges_m.assign(101, 4.F);
    scan.valid.assign(101, 0);
    for (scan.t = 0; scan.t < 3; scan.t += 0.1) EXPECT_TRUE(memory.observe(scan, {}, 0, std::vector<float>(101, free_m)).empty());
    scan.valid.assign(101, 1);
    std::fill(scan.ranges_m.begin() + 45, scan.ranges_m.begin() + 56, 2.F);
    EXPECT_EQ(memory.observe(scan, {}).size(), free_m > 2 ? 11u : 0u) << free_m;
  }
}

TEST(FreeSpaceMemory, AllRoundTheRobotAndWhileItTurns) {
  Watch watch;
  const auto room = test::asymmetricRoom();
  watch.lookFor(3, room, kStand);
  for (int i = 0; i < 60; ++i) {
    const double angle = i * 0.1;
    const Eigen::Vector2d place(0.5 + 1.4 * std::cos(angle), 0.3 + 1.4 * std::sin(angle));
    watch.look(with(room, personAt(place)), kStand * Pose2{0, 0, 0.05 * i}, place);
  }
  EXPECT_GT(watch.near.value(), 0.97);
  EXPECT_LT(watch.elsewhere.value(), 0.0005);
}

TEST(FreeSpaceMemory, WhatWasNeverSeenIsNotMoving) {
  // The robot drives past a doorway, behind which there is a room, and around a corner.
  std::vector<Wall> rooms = test::ring({{-6, -1}, {6, -1}, {6, 6}, {3, 6}, {3, 1.2}, {-6, 1.2}});
  rooms = with(rooms, test::boxAt(4, 3, 0.5, 0.5));
  Watch watch;
  Pose2 pose{-5, 0, 0};
  for (int i = 0; i < 180; ++i, pose = pose * Pose2{0.05, 0, 0}) watch.look(rooms, pose);
  for (int i = 0; i < 40; ++i, pose = pose * Pose2{0.02, 0, M_PI / 80}) watch.look(rooms, pose);
  for (int i = 0; i < 60; ++i, pose = pose * Pose2{0.05, 0, 0}) watch.look(rooms, pose);
  EXPECT_GT(watch.elsewhere.returns, 150000);
  EXPECT_LT(watch.elsewhere.value(), 0.0002);
}

TEST(FreeSpaceMemory, ErrorsOfThePoseContradictNothing) {
  auto room = test::asymmetricRoom();
  for (const Eigen::Vector2d& leg : {Eigen::Vector2d(1.2, 1.5), {1.8, 1.5}, {1.2, 2.0}, {-0.5, -1.2}})
    room = with(room, test::boxAt(leg.x(), leg.y(), 0.04, 0.04));
  for (const int beams : {360, 720}) {
    Watch watch;
    watch.beams = beams;
    watch.pose_sigma_m = 0.015;
    watch.pose_sigma_rad = 0.3 * M_PI / 180;
    for (int i = 0; i < 400; ++i) {
      const double angle = 0.02 * i;
      watch.look(room, {0.8 * std::sin(angle), 0.8 * (1 - std::cos(angle)) - 0.5, angle});
    }
    EXPECT_LT(watch.elsewhere.value(), 0.001) << beams;
  }
}

TEST(FreeSpaceMemory, BeamsAlongAThinWallDoNotFreeIt) {
  // A partition between two spaces that both are seen free, on a slant, so that it shares its cells with
  // beams.
  const auto walls = with(test::ring({{-2, -3}, {14, -3}, {14, 3}, {-2, 3}}),
                          {{{0, 0.13}, {12, 0.41}}, {{0, 0.15}, {12, 0.43}}});
  Watch watch;
  watch.pose_sigma_m = 0.01;
  for (int i = 0; i < 240; ++i) watch.look(walls, {-1.5 + 0.05 * i, -0.4, 0});
  EXPECT_LT(watch.elsewhere.value(), 0.0005);
  for (int i = 0; i < 240; ++i) watch.look(walls, {10.5 - 0.05 * i, 1.2, M_PI});
  EXPECT_LT(watch.elsewhere.value(), 0.0005);
}

TEST(FreeSpaceMemory, AClosedDoorIsMovingForAWhileOnly) {
  const auto walls =
      test::ring({{-2, -2}, {2, -2}, {2, -0.5}, {5, -0.5}, {5, 0.5}, {2, 0.5}, {2, 2}, {-2, 2}});
  const auto closed = with(walls, {{{2, -0.5}, {2, 0.5}}});
  Watch watch;
  watch.lookFor(4, walls, {});
  const Eigen::Vector2d middle(2, 0);
  watch.look(closed, {}, middle);
  EXPECT_GT(watch.near.value(), 0.9) << "it may be somebody in the doorway";
  watch.lookFor(6, closed, {}, middle);
  watch.forget();
  watch.lookFor(20, closed, {}, middle);
  EXPECT_EQ(watch.near.moving, 0) << "it stays";
  EXPECT_EQ(watch.elsewhere.moving, 0);
}

TEST(FreeSpaceMemory, WhatIsPutDownSettlesThoughBeamsMissIt) {
  const auto room = test::asymmetricRoom();
  const auto box = with(room, test::boxAt(2.4, 0.2, 0.2, 0.2));
  Watch watch;
  watch.lookFor(3, room, kStand);
  // Every third scan misses it.
  for (int i = 0; i < 120; ++i) watch.look(i % 3 ? box : room, kStand, {2.5, 0.3});
  EXPECT_GT(watch.near.moving, 100);
  watch.forget();
  for (int i = 0; i < 60; ++i) watch.look(i % 3 ? box : room, kStand, {2.5, 0.3});
  EXPECT_EQ(watch.near.moving, 0);
}

TEST(FreeSpaceMemory, LegsOfFurnitureDoNotMove) {
  const auto room = test::asymmetricRoom();
  for (const double side_m : {0.04, 0.14}) {
    Watch watch;
    watch.lookFor(3, room, kStand);
    watch.lookFor(1, with(room, test::boxAt(1.9, 0.2, side_m, side_m)), kStand, {1.95, 0.25});
    EXPECT_EQ(watch.near.moving > 0, side_m > 0.1) << side_m << ": somebody's leg is wider";
  }
}

TEST(FreeSpaceMemory, WhoeverSatForAMinuteLeavesAndIsMovingAgain) {
  const auto room = test::asymmetricRoom();
  const Eigen::Vector2d seat(2.5, 0.6), door(2.5, -1.2);
  Watch watch;
  watch.lookFor(3, room, kStand);
  watch.walk(room, kStand, door, seat);
  watch.lookFor(60, with(room, personAt(seat)), kStand, seat);
  watch.forget();
  watch.walk(room, kStand, seat + Eigen::Vector2d(0, -0.5), door);
  EXPECT_GT(watch.near.value(), 0.9);
  watch.lookFor(3, room, kStand);
  EXPECT_LT(watch.elsewhere.value(), 0.0005) << "walls that were hidden are back";
  watch.forget();
  watch.walk(room, kStand, door, seat);
  EXPECT_GT(watch.near.value(), 0.97) << "the seat is free again";
}

TEST(FreeSpaceMemory, AJumpOfThePoseIsNoCrowd) {
  const auto room = test::asymmetricRoom();
  Watch watch;
  watch.lookFor(4, room, kStand);
  // The robot stands; the frame of the poses moves, as after a wrong match.
  const Pose2 jump{0.7, -0.5, 0.3};
  for (int i = 0; i < 80; ++i) {
    const Scan scan = test::castScan(room, kStand, watch.t, watch.random, 0.01, 720);
    watch.t += kScanStep_s;
    EXPECT_TRUE(watch.memory.observe(scan, jump * kStand).empty()) << i;
  }
  // By then the room is known in its new place.
  const Eigen::Vector2d place(-1.2, -0.5);
  const Scan scan = test::castScan(with(room, personAt(place)), kStand, watch.t, watch.random, 0.01, 720);
  EXPECT_GT(watch.memory.observe(scan, jump * kStand).size(), 15u);
}

TEST(FreeSpaceMemory, OnlyLevelScansOfOneHeightCount) {
  const auto room = test::asymmetricRoom();
  const Eigen::Vector2d place(-1.2, -0.5);
  std::mt19937 random{5};
  Scan scan = test::castScan(with(room, personAt(place)), kStand, 100, random, 0.01, 720);
  const auto afterMount = [&](const Pose3& robot_from_lidar) {
    Watch watch;
    watch.lookFor(4, room, kStand);
    scan.robot_from_lidar = robot_from_lidar;
    scan.t = watch.t;
    return watch.memory.observe(scan, kStand).size();
  };
  EXPECT_GT(afterMount(Pose3::Identity()), 15u);
  EXPECT_EQ(afterMount(poseFromYpr(0, 0, 0, 0, 0.2, 0)), 0u) << "tilted: it sees the floor";
  EXPECT_EQ(afterMount(poseFromYpr(0, 0, 0.5, 0, 0, 0)), 0u) << "a second lidar: it sees table tops";
}

TEST(FreeSpaceMemory, FreeSpaceIsForgotten) {
  const auto room = test::asymmetricRoom();
  const Eigen::Vector2d place(-1.2, -0.5);
  for (const double pause_s : {10.0, 40.0}) {
    Watch watch;
    watch.lookFor(4, room, kStand);
    watch.t += pause_s;
    watch.look(with(room, personAt(place)), kStand, place);
    EXPECT_EQ(watch.near.moving > 0, pause_s < 30) << pause_s;
  }
}

// The grid rolls: what is known of one place must not be taken for another's. 25.6 m is the period of the
// default grid.
TEST(FreeSpaceMemory, FarPlacesAreNotMixedUp) {
  for (const Eigen::Vector2d& away :
       {Eigen::Vector2d(25.6, 0), {-25.6, 0}, {0, 25.6}, {0, -25.6}, {51.2, -25.6}}) {
    const auto room = test::asymmetricRoom();
    Watch watch;
    watch.lookFor(4, room, kStand);
    const int steps = 20;
    for (int i = 1; i <= steps; ++i) {
      Scan nothing = test::castScan({}, kStand, watch.t += kScanStep_s, watch.random, 0, 720);
      const Eigen::Vector2d shift = away * i / steps;
      watch.memory.observe(nothing, {kStand.x + shift.x(), kStand.y + shift.y(), kStand.yaw});
    }
    Scan scan = test::castScan(with(room, personAt({-1.2, -0.5})), kStand, watch.t += kScanStep_s,
                               watch.random, 0.01, 720);
    EXPECT_TRUE(watch.memory.observe(scan, {kStand.x + away.x(), kStand.y + away.y(), kStand.yaw}).empty())
        << away.transpose();
  }
}

// Somebody stops for three seconds before a robot that takes every scan into its map.
ScanMatch afterSomebodyStopped(bool leave_out) {
  const auto room = test::asymmetricRoom();
  const auto crowded = with(room, personAt({-1.2, -0.5}));
  std::mt19937 random{17};
  SubmapScanMatcher matcher;
  const std::string keys =
      std::string("[lidar]\nkeep_time_s = 0.05\nleave_out_moving = ") + (leave_out ? "true" : "false");
  Config::fromText(keys, "test").read("lidar", matcher);
  matcher.prepare();
  ScanMatch last;
  for (int i = 0; i < 60; ++i) {
    last = matcher.match(test::castScan(i < 30 ? room : crowded, kStand, 0.1 * i, random), {});
    if (i < 30) {
      EXPECT_TRUE(last.moving.empty()) << i;
    }
  }
  return last;
}

TEST(SubmapScanMatcher, WhatMovesIsTold) {
  const ScanMatch off = afterSomebodyStopped(false), on = afterSomebodyStopped(true);
  EXPECT_TRUE(off.moving.empty());
  EXPECT_GT(on.moving.size(), 8U);
  EXPECT_EQ(on.score, off.score) << "its own map holds all returns";
}

// Wheels that slip move the prediction, not the scan's pose, from which free space is told.
TEST(SubmapScanMatcher, SlippingWheelsMakeNothingMove) {
  const auto room = test::asymmetricRoom();
  std::mt19937 random{17};
  SubmapScanMatcher matcher;
  matcher.prepare();
  std::size_t moving = 0;
  for (int i = 0; i < 200; ++i) {
    const Pose2 pose{0.7 * std::sin(0.03 * i), 0.7 * (1 - std::cos(0.03 * i)) - 0.5, 0.03 * i};
    const bool slips = i % 40 > 30;
    const Pose2 step{slips ? 0.1 : 0.021, 0, slips ? 0.09 : 0.03};
    const ScanMatch match = matcher.match(test::castScan(room, pose, 0.1 * i, random), step);
    ASSERT_TRUE(match.matched);
    moving += match.moving.size();
  }
  EXPECT_LT(moving, 40u) << "of 70000 returns";
}

}  // namespace
}  // namespace roomgraph
