// SPDX-License-Identifier: BSD-3-Clause
// Whether a place along a corridor is known: plain walls, doors that are all alike, and one that is alone.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "corridor.h"
#include "roomgraph/core/config.h"
#include "submap_loop_closer.h"
#include "synthetic_scans.h"

namespace roomgraph {
namespace {

// Two walls 2 m apart, the upper one with recesses of .2 m at these places.
std::vector<test::Wall> withDoors(const std::vector<double>& doors) {
  std::vector<test::Wall> walls{{{-20, -1}, {20, -1}}};
  double from = -20;
  for (const double door : doors) {
    const double left = door - 0.4, right = door + 0.4;
    for (const auto& wall : std::vector<test::Wall>{{{from, 1}, {left, 1}}, {{left, 1}, {left, 1.2}}, {{left, 1.2}, {right, 1.2}}, {{right, 1.2}, {right, 1}}})
      walls.push_back(wall);
    from = right;
  }
  walls.push_back({{from, 1}, {20, 1}});
  return walls;
}

Scan nearScan(const std::vector<test::Wall>& walls, const Pose2& pose, double t, double reach_m, std::mt19937& random) {
  Scan scan = test::castScan(walls, pose, t, random, 0.005);
  for (std::size_t beam = 0; beam < scan.ranges_m.size(); ++beam) scan.valid[beam] = scan.valid[beam] && scan.ranges_m[beam] < reach_m;
  return scan;
}

struct Fitted {
  ScorePyramid pyramid;
  Points2 points;
  GridRefinement fit;
  double score = 0;
};

// A scan at the middle in the map of such scans, turned by `heading`.
Fitted fitIn(const std::vector<test::Wall>& walls, double heading) {
  std::mt19937 random(11);
  const auto scanAt = [&](double x) { return toPlanarScan(nearScan(walls, {x, 0, 0}, 0, 3, random), 0.1, 30); };
  ProbabilityGrid grid(0.05);
  const GridUpdate update{0.6, 0.48};
  for (int i = -20; i <= 20; ++i) grid.insert(scanAt(0.1 * i), Pose2{0, 0, heading} * Pose2{0.1 * i, 0, 0}, update);
  Fitted out{ScorePyramid(grid, 1), scanAt(0).points, {}, 0};
  out.fit = refineOnGrid(grid, out.points, {0, 0, heading}, {{0, 0, heading}});
  std::vector<ScorePyramid::Cell> cells;
  for (const Eigen::Vector2d& point : transformed(out.fit.grid_from_scan, out.points)) {
    const Eigen::Vector2d at = (point - grid.corner()) / grid.cellSize();
    cells.push_back({static_cast<int>(std::floor(at.x())), static_cast<int>(std::floor(at.y()))});
  }
  out.score = out.pyramid.sum(0, cells, {0, 0}) / (255.0 * static_cast<double>(out.points.size()));
  return out;
}

TEST(Corridor, DoorsThatAreAllAlikeFitEachOther) {
  for (const double heading : {0.0, 0.5, M_PI / 2, -2.5}) {
    const Fitted alike = fitIn(withDoors({-4, -3, -2, -1, 0, 1, 2, 3, 4}), heading), alone = fitIn(withDoors({0}), heading), plain = fitIn(withDoors({}), heading);
    EXPECT_TRUE(fitsAlong(alike.pyramid, alike.points, alike.fit, 0.93 * alike.score)) << heading;
    EXPECT_FALSE(fitsAlong(alone.pyramid, alone.points, alone.fit, 0.93 * alone.score)) << heading;
    EXPECT_TRUE(fitsAlong(plain.pyramid, plain.points, plain.fit, 0.93 * plain.score)) << heading;
    EXPECT_TRUE(isCorridor(plain.fit));
  }
  EXPECT_FALSE(isCorridor(fitIn(test::ring({{-2, -2}, {2, -2}, {2, 2}, {-2, 2}}), 0).fit));
}

// Beyond 1.5 m is for others to tell.
TEST(Corridor, OnlyPlacesNearByAreCompared) {
  const Fitted far = fitIn(withDoors({-3.6, -1.8, 0, 1.8, 3.6}), 0), near = fitIn(withDoors({-2.4, -1.2, 0, 1.2, 2.4}), 0);
  EXPECT_FALSE(fitsAlong(far.pyramid, far.points, far.fit, 0.93 * far.score));
  EXPECT_TRUE(fitsAlong(near.pyramid, near.points, near.fit, 0.93 * near.score));
}

// To and fro, with what was driven since 2 mm a scan too long.
std::size_t loopsToAndFro(const std::vector<double>& doors) {
  SubmapLoopCloser closer;
  closer.prepare();
  std::mt19937 random(13);
  Trajectory world;
  std::size_t closures = 0;
  for (int i = 0; i < 300; ++i) {
    const double x = 0.1 * (i % 100 < 50 ? i % 50 : 50 - i % 50) - 2.5, t = 0.2 * i;
    ScanMatch match;
    match.matched = true;
    match.odom_from_robot = {x + 0.002 * i, 0, 0};
    world.add(t, toPose3(match.odom_from_robot));
    closer.add(nearScan(withDoors(doors), {x, 0, 0}, t, 3, random), match);
    closures += closer.search([&](double at) { return world.at(at); }).size();
  }
  return closures;
}

TEST(Corridor, DoorsThatAreAllAlikeCloseNoLoop) {
  std::vector<double> alike;
  for (int i = -18; i <= 18; ++i) alike.push_back(i);
  EXPECT_EQ(loopsToAndFro(alike), 0u);
  EXPECT_GE(loopsToAndFro({-1.3, 0, 0.9}), 10u);
}

// Along a way and once more, where the odometry begins to say twice as much after 2 m: closures that follow the scans by more than .6 m.
std::size_t closuresAgainstTheOdometry(const std::vector<test::Wall>& walls, double reach_m) {
  SubmapLoopCloser closer;
  Config::fromText("[lidar.loop_closing]\nscans_per_submap = 10\n").read("lidar.loop_closing", closer);
  closer.prepare();
  std::mt19937 random(14);
  Trajectory odom;
  std::size_t against = 0;
  for (int i = 0; i < 120; ++i) {
    const int again = i - 50, slipping = std::max(0, again - 20);
    const double x = 0.1 * (again < 0 ? i : again - 0.5 * slipping) - 2, t = 0.2 * i;
    ScanMatch match;
    match.matched = true;
    match.odom_from_robot = {x + 0.1 * 0.5 * slipping, 0, 0};
    odom.add(t, toPose3(match.odom_from_robot));
    closer.add(nearScan(walls, {x, 0, 0}, t, reach_m, random), match);
    for (const RelativePose& closure : closer.search([&](double at) { return odom.at(at); })) {
      const double by_odometry = odom.at(closure.t_b)->translation().x() - odom.at(closure.t_a)->translation().x();
      against += std::abs(closure.a_from_b.translation().x() - by_odometry) > 0.6;
    }
  }
  return against;
}

// In a room, where walls face all ways, scans know better than wheels that slip.
TEST(Corridor, ClosuresAgainstTheOdometryAreNotBelieved) {
  EXPECT_EQ(closuresAgainstTheOdometry(withDoors({-1.3, 0, 0.9, 3}), 3), 0u);
  EXPECT_GE(closuresAgainstTheOdometry(test::asymmetricRoom(), 10), 10u);
}

// Along a corridor, round and round a room far away, and back to the corridor's first doors, where the robot rightly takes itself to be.
std::size_t returnsTo(const std::vector<double>& doors, int scans = 32) {
  const auto corridor = withDoors(doors), room = test::ring({{57, -3}, {65, -3}, {65, 2.5}, {62, 2.5}, {62, 4}, {57, 3}});
  SubmapLoopCloser closer;
  Config::fromText("[lidar.loop_closing]\nscans_per_submap = 20\n").read("lidar.loop_closing", closer);
  closer.prepare();
  std::mt19937 random(12);
  Trajectory world;
  const auto drive = [&](const std::vector<test::Wall>& walls, const Pose2& pose) {
    const double t = 0.2 * static_cast<double>(world.size());
    ScanMatch match;
    match.matched = true;
    match.odom_from_robot = pose;
    world.add(t, toPose3(pose));
    closer.add(nearScan(walls, pose, t, 3, random), match);
    return closer.search([&](double at) { return world.at(at); });
  };
  for (int i = 0; i < 120; ++i) drive(corridor, {0.1 * i - 1.5, 0, 0});
  for (int i = 0; i < 500; ++i) drive(room, {60 + std::cos(0.1 * i), std::sin(0.1 * i), wrapAngle(0.1 * i + M_PI / 2)});
  std::size_t returns = 0;
  for (int i = 0; i < scans; ++i) returns += drive(corridor, {0.1 * i - 0.5, 0, 0}).size();
  return returns;
}

TEST(Corridor, DoorsThatAreElsewhereTooDoNotTellThePlace) {
  EXPECT_EQ(returnsTo({0.3, 1.3, 2.0, 7.3, 8.3, 9.0}), 0u);
  EXPECT_GE(returnsTo({0.3, 1.3, 2.0, 8.3}), 3u) << "one door is not three";
  EXPECT_GE(returnsTo({-0.4, 0.3, 1.3, 2.0, 8.3, 9.0}), 3u) << "the last scans fit there, too, but none before";
}

// After 130 m the place may be anywhere on four metres: more than two of them must agree.
TEST(Corridor, AfterALongWayAMetreOfAgreementIsNotEnough) {
  EXPECT_EQ(returnsTo({0.3, 1.3, 2.0}, 20), 0u);
  EXPECT_GE(returnsTo({0.3, 1.3, 2.0}), 3u);
}

}  // namespace
}  // namespace roomgraph
