// SPDX-License-Identifier: BSD-3-Clause
// SubmapLoopCloser in simulated rooms: true returns, similar rooms, verification.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "roomgraph/core/config.h"
#include "submap_loop_closer.h"
#include "synthetic_scans.h"

namespace roomgraph {
namespace {

std::vector<test::Wall> shifted(std::vector<test::Wall> walls, double dx) {
  for (test::Wall& wall : walls) {
    wall.from.x() += dx;
    wall.to.x() += dx;
  }
  return walls;
}

/// Drives on an oval inside the room, `scans` scans of 10 cm; the pose is that in the room.
std::vector<Pose2> oval(int scans) {
  std::vector<Pose2> poses;
  for (int i = 0; i < scans; ++i) {
    const double a = 0.1 * i / 1.1;
    poses.push_back({0.8 + 1.4 * std::cos(a), 0.3 + 0.8 * std::sin(a), wrapAngle(a + M_PI / 2)});
  }
  return poses;
}

struct Pass {
  std::vector<test::Wall> walls;
  std::vector<Pose2> poses;  ///< in the world of the walls
  Pose2 odom_from_world;     ///< drift the matcher has gathered until then
  bool anywhere = false;     ///< begins a segment after a pause in which the robot was carried
  bool lost = false;         ///< begins a segment after a loss: the place in world is about right
};

struct Found {
  std::vector<RelativePose> closures;
  std::vector<double> times;
  std::vector<Pose2> truth;
};

Found drive(const std::vector<Pass>& passes, SubmapLoopCloser& closer) {
  std::mt19937 random(31);
  closer.prepare();
  Found out;
  Trajectory world;
  int segment = 0;
  for (const Pass& pass : passes) {
    segment += pass.anywhere || pass.lost;
    for (const Pose2& pose : pass.poses) {
      const double t = 0.2 * static_cast<double>(out.times.size());
      ScanMatch match;
      match.matched = true;
      match.odom_from_robot = pass.odom_from_world * pose;
      match.segment = segment;
      match.anywhere = pass.anywhere && &pose == &pass.poses.front();
      world.add(t, toPose3(match.odom_from_robot));
      closer.add(test::castScan(pass.walls, pose, t, random), match);
      for (const RelativePose& closure : closer.search([&](double at) { return world.at(at); })) out.closures.push_back(closure);
      out.times.push_back(t);
      out.truth.push_back(pose);
    }
  }
  return out;
}

Found drive(const std::vector<Pass>& passes) {
  SubmapLoopCloser closer;
  return drive(passes, closer);
}

TEST(SubmapLoopCloser, FindsTheReturnAndItsRelativePose) {
  const auto room = test::asymmetricRoom();
  const Found found = drive({{room, oval(170), {}}, {room, oval(60), {0.35, -0.2, 0.06}}});
  const auto index = [](double t) { return static_cast<std::size_t>(std::lround(t / 0.2)); };
  int of_second_pass = 0;
  for (const RelativePose& c : found.closures) {
    const Pose2 truth = found.truth[index(c.t_a)].inverse() * found.truth[index(c.t_b)];
    const Pose2 error = truth.inverse() * planarPart(c.a_from_b);
    EXPECT_LT(std::hypot(error.x, error.y), 0.05) << c.t_a << " " << c.t_b;
    EXPECT_LT(std::abs(error.yaw), 0.03);
    EXPECT_LT(c.covariance(0, 0), 0.05 * 0.05);
    EXPECT_TRUE(c.planar);
    EXPECT_EQ(c.source, "lidar");
    of_second_pass += index(c.t_b) >= 170 && index(c.t_a) < 100;
  }
  EXPECT_GE(of_second_pass, 5);
}

TEST(SubmapLoopCloser, DoesNotJoinSimilarRooms) {
  // The second room has the same size, but other furniture and a corner cut differently.
  auto other = test::ring({{-3, -2}, {5, -2}, {5, 2.9}, {3.4, 2.9}, {3.4, 3.6}, {-3, 3.4}});
  for (const auto& wall : test::boxAt(-1.6, -1.6, 0.9, 0.6)) other.push_back(wall);
  for (const auto& wall : test::boxAt(0.3, 0, 0.7, 0.7)) other.push_back(wall);
  const Found found = drive({{test::asymmetricRoom(), oval(170), {}}, {other, oval(60), {0.3, 0.2, 0}}});
  for (const RelativePose& c : found.closures) EXPECT_FALSE(c.t_b >= 0.2 * 170 && c.t_a < 0.2 * 170);
}

// Carried across the room, turned by more than a search around the old place reaches: the whole submaps are searched.
TEST(SubmapLoopCloser, ASegmentThatMayBeAnywhereIsFoundInWholeSubmaps) {
  const auto room = test::asymmetricRoom();
  const Pose2 odom_from_world{7, -5, 2.6};
  const Found lost = drive({{room, oval(170), {}}, {room, oval(90), odom_from_world}});
  const auto ofSecondPass = [](const Found& found) {
    std::vector<RelativePose> out;
    for (const RelativePose& c : found.closures)
      if (c.t_b >= 0.2 * 170 && c.t_a < 0.2 * 170) out.push_back(c);
    return out;
  };
  EXPECT_TRUE(ofSecondPass(lost).empty()) << "too far from where it should be";
  const Found found = drive({{room, oval(170), {}}, {room, oval(90), odom_from_world, true}});
  const auto closures = ofSecondPass(found);
  ASSERT_GE(closures.size(), 8u) << "and loops close as ever after that";
  EXPECT_GE(closures.front().t_b, 0.2 * 170);
  for (const RelativePose& c : closures) {
    const auto index = [](double t) { return static_cast<std::size_t>(std::lround(t / 0.2)); };
    const Pose2 error = (found.truth[index(c.t_a)].inverse() * found.truth[index(c.t_b)]).inverse() * planarPart(c.a_from_b);
    EXPECT_LT(std::hypot(error.x, error.y), 0.05) << c.t_a << " " << c.t_b;
    EXPECT_LT(std::abs(error.yaw), 0.03);
  }
  std::map<double, int> of_scan;
  for (const RelativePose& c : closures) EXPECT_LE(++of_scan[c.t_b], 4) << c.t_b << ": two submaps by guess, two searched whole";
}

// A square room looks the same from four sides; two rooms of one shape look the same, however many scans agree on one of them.
TEST(SubmapLoopCloser, ASegmentThatMayBeInTwoPlacesIsNotPlaced) {
  const auto square = test::boxAt(-1.5, -2, 5, 5), room = test::asymmetricRoom();
  std::vector<Pose2> beside = oval(170), seldom = oval(100);
  for (Pose2& pose : beside) pose.x += 20;
  for (Pose2& pose : seldom) pose.x += 20;
  for (const Found& found : {drive({{square, oval(170), {}}, {square, oval(90), {7, -5, 2.6}, true}}),
                             drive({{room, oval(170), {}}, {shifted(room, 20), beside, {}}, {room, oval(90), {7, -5, 2.6}, true}}),
                             drive({{room, oval(600), {}}, {shifted(room, 20), seldom, {}}, {room, oval(90), {7, -5, 2.6}, true}})}) {
    const double carried_t = found.times[found.times.size() - 90];
    for (const RelativePose& c : found.closures) EXPECT_FALSE(c.t_b >= carried_t && c.t_a < carried_t) << c.t_a << ' ' << c.t_b;
  }
}

// A segment that begins after a loss is about where it should be: three scans that agree are enough.
TEST(SubmapLoopCloser, ASegmentAfterALossIsFoundSooner) {
  const auto room = test::asymmetricRoom();
  const auto ofSecondPass = [](const Found& found) {
    return std::count_if(found.closures.begin(), found.closures.end(), [](const RelativePose& c) { return c.t_b >= 0.2 * 170 && c.t_a < 0.2 * 170; });
  };
  EXPECT_GE(ofSecondPass(drive({{room, oval(170), {}}, {.walls = room, .poses = oval(20), .lost = true}})), 3);
  EXPECT_EQ(ofSecondPass(drive({{room, oval(170), {}}, {.walls = room, .poses = oval(20), .anywhere = true}})), 0);
}

// Once it is tied loops close as they ever did, with what came before and over later losses.
TEST(SubmapLoopCloser, WhatIsTiedIsNotAdriftAnyMore) {
  const auto room = test::asymmetricRoom();
  SubmapLoopCloser closer;
  drive({{room, oval(170), {}}, {room, oval(150), {7, -5, 2.6}, true}}, closer);
  const auto verified = closer.verify({.t_a = 2, .t_b = 0.2 * 300, .a_from_b = toPose3(oval(170)[10].inverse() * oval(150)[130])});
  ASSERT_TRUE(verified);
  const Pose2 error = (oval(170)[static_cast<std::size_t>(std::lround(verified->t_a / 0.2))].inverse() *
                       oval(150)[static_cast<std::size_t>(std::lround(verified->t_b / 0.2)) - 170]).inverse() * planarPart(verified->a_from_b);
  EXPECT_LT(std::hypot(error.x, error.y), 0.05);
}

TEST(SubmapLoopCloser, FarPlacesAreNotCompared) {
  const auto room = test::asymmetricRoom();
  const Found found = drive({{room, oval(170), {}}, {shifted(room, 0), oval(60), {60, 0, 0}}});
  for (const RelativePose& c : found.closures) EXPECT_FALSE(c.t_b >= 0.2 * 170 && c.t_a < 0.2 * 170);
}

// Round and round in one room: submaps of later laps repeat those of the first.
TEST(SubmapLoopCloser, SubmapsThatRepeatOlderOnesAreGivenUpAndLoopsCloseStill) {
  constexpr int kScans = 1000, kLap = 76;  // about 13 laps
  const auto room = test::asymmetricRoom();
  SubmapLoopCloser all, few;
  Config::fromText("[lidar.loop_closing]\nsubmaps_kept = 4\n").read("lidar.loop_closing", few);
  const Found with_all = drive({{room, oval(kScans), {}}}, all), with_few = drive({{room, oval(kScans), {}}}, few);
  EXPECT_GT(all.submapsHeld(), 12);
  EXPECT_LE(few.submapsHeld(), 4 + 7) << "the latest are not looked at yet";
  const auto inLastLap = [](const Found& found) {
    return std::count_if(found.closures.begin(), found.closures.end(),
                         [](const RelativePose& c) { return c.t_b > 0.2 * (kScans - kLap); });
  };
  EXPECT_GT(inLastLap(with_few), 10);
  EXPECT_GT(inLastLap(with_few), inLastLap(with_all) / 2);
  for (const RelativePose& c : with_few.closures) {
    const auto index = [](double t) { return static_cast<std::size_t>(std::lround(t / 0.2)); };
    const Pose2 error = (with_few.truth[index(c.t_a)].inverse() * with_few.truth[index(c.t_b)]).inverse() * planarPart(c.a_from_b);
    EXPECT_LT(std::hypot(error.x, error.y), 0.05) << c.t_a << " " << c.t_b;
  }
  const auto truthOf = [&](double t) { return with_few.truth[static_cast<std::size_t>(std::lround(t / 0.2))]; };
  const auto proposed = [&](int a, int b) {
    return RelativePose{.t_a = 0.2 * a, .t_b = 0.2 * b, .a_from_b = toPose3(truthOf(0.2 * a).inverse() * truthOf(0.2 * b))};
  };
  EXPECT_TRUE(few.verify(proposed(10, kScans - 10)));
  EXPECT_FALSE(few.verify(proposed(10, kScans / 2))) << "the later scan was given up";
  // For an earlier one that was given up the one that it repeats stands.
  const auto by_another = few.verify(proposed(kScans / 2, kScans - 10));
  ASSERT_TRUE(by_another);
  EXPECT_GT(std::abs(by_another->t_a - 0.2 * kScans / 2), 5);
  const Pose2 error = (truthOf(by_another->t_a).inverse() * truthOf(by_another->t_b)).inverse() * planarPart(by_another->a_from_b);
  EXPECT_LT(std::hypot(error.x, error.y), 0.05);
}

// What is seen the other way round is another place.
TEST(SubmapLoopCloser, OtherDirectionsAreNotGivenUp) {
  const auto room = test::asymmetricRoom();
  const auto heldAfter = [&](bool turned_in_the_end) {
    std::vector<Pose2> way = oval(900);
    for (std::size_t i = way.size() / 2; i < way.size(); ++i)
      if (turned_in_the_end) way[i].yaw = wrapAngle(way[i].yaw + M_PI);
    SubmapLoopCloser few;
    Config::fromText("[lidar.loop_closing]\nsubmaps_kept = 4\n").read("lidar.loop_closing", few);
    drive({{room, way, {}}}, few);
    return few.submapsHeld();
  };
  EXPECT_GT(heldAfter(true), heldAfter(false));
}

TEST(SubmapLoopCloser, SameInputSameOutput) {
  const auto room = test::asymmetricRoom();
  const std::vector<Pass> passes{{room, oval(200), {}}};
  const Found first = drive(passes), second = drive(passes);
  ASSERT_EQ(first.closures.size(), second.closures.size());
  for (std::size_t i = 0; i < first.closures.size(); ++i) {
    EXPECT_EQ(first.closures[i].a_from_b.matrix(), second.closures[i].a_from_b.matrix());
    EXPECT_EQ(first.closures[i].covariance, second.closures[i].covariance);
  }
}

/// A pass of 170 poses and the begin of a second, before which the odometry is lost: search alone would look elsewhere.
void passTwice(const std::vector<test::Wall>& walls, const std::vector<Pose2>& poses, SubmapLoopCloser& closer) {
  constexpr double kFar_m = 40;
  std::mt19937 random(5);
  closer.prepare();
  for (int i = 0; i < 230; ++i) {
    const Pose2 pose = poses[static_cast<std::size_t>(i % 170)];
    ScanMatch match;
    match.matched = true;
    match.odom_from_robot = i < 170 ? pose : Pose2{kFar_m, 0, 0.5} * pose;
    match.segment = i < 170 ? 0 : 1;
    closer.add(test::castScan(walls, pose, 0.2 * i, random), match);
  }
}

TEST(SubmapLoopCloser, ACorridorConfirmsNothing) {
  const auto poses = oval(170);
  RelativePose proposed;
  proposed.t_a = 0.2 * 20;
  proposed.t_b = 0.2 * 195;
  proposed.a_from_b = toPose3(poses[20].inverse() * poses[25]);
  SubmapLoopCloser in_a_room, in_a_corridor;
  passTwice(test::asymmetricRoom(), poses, in_a_room);
  passTwice(test::corridor(), poses, in_a_corridor);
  EXPECT_TRUE(in_a_room.verify(proposed));
  EXPECT_FALSE(in_a_corridor.verify(proposed)) << "a metre farther along it looks the same";
}

// The map holds the walls of a room as they are seen inside, the scans to be placed see them from outside: walls have
// a thickness, so that these cannot be the same.
TEST(SubmapLoopCloser, WallsSeenFromBehindConfirmNothing) {
  const auto walls = test::asymmetricRoom();
  const auto inside = oval(170);
  std::vector<Pose2> outside;
  for (int i = 0; i < 60; ++i) outside.push_back({6.5 - 0.02 * i, -4 + 0.01 * i, 0.02 * i});
  for (const bool through : {false, true}) {
    std::mt19937 random(5);
    SubmapLoopCloser closer;
    closer.prepare();
    for (int i = 0; i < 230; ++i) {
      const bool first = i < 170;
      const Pose2 pose = first ? inside[static_cast<std::size_t>(i)]
                               : (through ? outside : inside)[static_cast<std::size_t>(i - 170)];
      ScanMatch match{.matched = true};
      match.odom_from_robot = first ? pose : Pose2{40, 0, 0.5} * pose;
      match.segment = first ? 0 : 1;
      closer.add(test::castScan(walls, pose, 0.2 * i, random), match);
    }
    RelativePose proposed;
    proposed.t_a = 0.2 * 20;
    proposed.t_b = 0.2 * 195;
    proposed.a_from_b = toPose3(inside[20].inverse() * (through ? outside[25] : inside[25]));
    EXPECT_EQ(closer.verify(proposed).has_value(), !through);
  }
}

TEST(SubmapLoopCloser, ConfirmsAProposedClosureAndRefusesAWrongOne) {
  const auto poses = oval(170);
  SubmapLoopCloser closer;
  passTwice(test::asymmetricRoom(), poses, closer);
  RelativePose proposed;
  proposed.t_a = 0.2 * 20;
  proposed.t_b = 0.2 * 195;
  const Pose2 truth = poses[20].inverse() * poses[25];
  proposed.a_from_b = toPose3(truth * Pose2{0.2, -0.15, 0.1});
  const RelativePose right = proposed;
  const auto confirmed = closer.verify(right);
  ASSERT_TRUE(confirmed);
  const auto at = [&](double t) { return poses[static_cast<std::size_t>(std::lround(t / 0.2)) % 170]; };
  const Pose2 error =
      (at(confirmed->t_a).inverse() * at(confirmed->t_b)).inverse() * planarPart(confirmed->a_from_b);
  EXPECT_LT(std::hypot(error.x, error.y), 0.05);
  EXPECT_LT(std::abs(error.yaw), 0.03);

  proposed.a_from_b = toPose3(truth * Pose2{1.8, 1.5, 1.2});
  EXPECT_FALSE(closer.verify(proposed));
  proposed.t_b = 1000;
  EXPECT_FALSE(closer.verify(proposed)) << "no scan at that time";

  EXPECT_TRUE(closer.verify(right));
  closer.release();
  EXPECT_FALSE(closer.verify(right)) << "what scans showed is given up";
}

}  // namespace
}  // namespace roomgraph
