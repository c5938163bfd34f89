// SPDX-License-Identifier: BSD-3-Clause
// Pieces of one recording: where their paths meet, and the map of both.
#include "roomgraph/maptools/piece_union.h"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "two_sessions.h"

namespace roomgraph::test {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

/// Ten instants a second along a curve through the flat.
Pose2 truePose(double t) {
  return {2 + 1.5 * std::cos(0.3 * t), 2.8 + 0.8 * std::sin(0.6 * t), 0.3 * t};
}

std::vector<StampedPose> pathIn(const Pose2& frame_from_world, double from, double until) {
  std::vector<StampedPose> out;
  for (int i = static_cast<int>(std::lround(10 * from)); i <= static_cast<int>(std::lround(10 * until)); ++i)
    out.push_back({0.1 * i, toPose3(frame_from_world * truePose(0.1 * i))});
  return out;
}

double apart(const Pose2& a, const Pose2& b) {
  const Pose2 between = a.inverse() * b;
  return std::hypot(between.x, between.y) + std::abs(between.yaw);
}

TEST(PathsOfPieces, MeetWhereTheyAreOfTheSameTime) {
  for (const double yaw : {0.3, 3.1, -3.1, 1.57}) {
    const Pose2 b_from_world{-3, 1.2, yaw};
    const auto met = alignPaths(pathIn({}, 0, 30), pathIn(b_from_world, 20, 50));
    ASSERT_TRUE(met) << met.reason();
    EXPECT_LT(apart(met->a_from_b, b_from_world.inverse()), 1e-9);
    EXPECT_EQ(met->poses, 101);
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (int i = 200; i <= 300; ++i) sum += Eigen::Vector2d(truePose(0.1 * i).x, truePose(0.1 * i).y);
    EXPECT_LT((met->middle - sum / 101).norm(), 1e-9);
    EXPECT_LT(met->rms_m, 1e-9);
  }
}

TEST(PathsOfPieces, TheFirstMomentsOfAPieceDoNotPull) {
  const Pose2 b_from_world{0.5, -1, 2};
  auto b = pathIn(b_from_world, 20, 50);
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.01);
  for (std::size_t i = 0; i < b.size(); ++i) {
    b[i].pose.translation().x() += noise(random) + (i < 30 ? 0.5 : 0);  // 3 of 10 s
    b[i].pose.translation().y() += noise(random);
  }
  const auto met = alignPaths(pathIn({}, 0, 30), b);
  ASSERT_TRUE(met) << met.reason();
  const Eigen::Vector2d there(3, 2);
  EXPECT_LT((met->a_from_b * (b_from_world * there) - there).norm(), 0.03);
  EXPECT_NEAR(met->rms_m, 0.5 * std::sqrt(0.3), 0.03);
}

TEST(PathsOfPieces, DoNotMeetWithoutAReason) {
  EXPECT_THAT(alignPaths(pathIn({}, 0, 20), pathIn({}, 19.7, 40)).reason(),
              HasSubstr("4 instants in common"));
  EXPECT_THAT(alignPaths(pathIn({}, 0, 20), {}).reason(), HasSubstr("0 instants in common"));
  auto other = pathIn({}, 20, 50);
  for (auto& stamped : other) stamped.pose.translation() *= 3;
  EXPECT_THAT(alignPaths(pathIn({}, 0, 30), other).reason(), HasSubstr("differ by"));
}

TEST(PathsOfPieces, GoOverIntoEachOther) {
  auto a = pathIn({}, 0, 30), b = pathIn({}, 20, 50);
  for (auto& stamped : b) stamped.pose.translation().x() += 0.1;
  b.erase(b.begin() + 7);  // an instant that only the first one has
  const auto joined = joinedPaths(a, b);
  ASSERT_THAT(joined, SizeIs(501));
  for (std::size_t i = 0; i < joined.size(); ++i) {
    const double t = 0.1 * static_cast<double>(i), share = std::clamp((t - 20) / 10, 0.0, 1.0);
    EXPECT_NEAR(joined[i].t, t, 1e-9);
    // Where one of them has no pose of its own, it is interpolated along the curve.
    EXPECT_NEAR(joined[i].pose.translation().x() - truePose(t).x, 0.1 * share, 1e-3) << t;
  }
  EXPECT_THAT(joinedPaths(pathIn({}, 0, 5), pathIn({}, 6, 9)), SizeIs(51 + 31));
  EXPECT_THAT(joinedPaths({}, a), SizeIs(301));
}

CSemanticMap pieceMap(const Pose2& frame_from_world, double from, double until, bool left,
                      const Pose2& path_error = {}) {
  auto map = sessionMap(flatWalls(), flatObjects(), frame_from_world, 1000,
                        [left](const Eigen::Vector2d& p) { return left ? p.x() > 6 : p.x() < 2; });
  std::erase_if(map.landmarks, [&](const Landmark& object) {
    const double x = (frame_from_world.inverse() * Eigen::Vector2d(object.position.head<2>())).x();
    return left ? x > 6 : x < 2;
  });
  map.world_from_robot = pathIn(frame_from_world * path_error, from, until);
  map.origin = "lab.rawlog";
  return map;
}

double worstPlace(const CSemanticMap& map) {
  double worst = 0;
  for (const auto& object : map.landmarks) {
    double nearest = 1e9;
    for (const auto& truth : flatObjects())
      if (truth.class_name == object.class_name)
        nearest = std::min(nearest, (truth.position.head<2>() - object.position.head<2>()).norm());
    worst = std::max(worst, nearest);
  }
  return worst;
}

TEST(MapsOfPieces, AreOneMap) {
  const auto joined = unitedPieces(pieceMap({}, 0, 30, true), pieceMap({1, -2, 0.7}, 20, 50, false));
  ASSERT_TRUE(joined) << joined.reason();
  EXPECT_TRUE(joined->by_maps) << joined->why_not;
  EXPECT_THAT(joined->map.landmarks, SizeIs(flatObjects().size()));
  EXPECT_LT(worstPlace(joined->map), 0.05);
  EXPECT_THAT(joined->map.world_from_robot, SizeIs(501));
  EXPECT_EQ(joined->map.origin, "lab.rawlog");
  for (const auto& line : joined->map.provenance.history)
    EXPECT_THAT(line, ::testing::Not(HasSubstr("left out")));
}

TEST(MapsOfPieces, WhatBothSawAtOnceIsSeenOnce) {
  CSemanticMap a = pieceMap({}, 0, 30, true), b = pieceMap({}, 20, 50, false);
  for (CSemanticMap* map : {&a, &b})
    for (Landmark& object : map->landmarks) {
      object.covariance = 0.01 * Eigen::Matrix4d::Identity();
      object.observations = 10;
      map->seen[object.id] = {20, 30};
    }
  const auto joined = unitedPieces(a, b);
  ASSERT_TRUE(joined) << joined.reason();
  ASSERT_LT(joined->map.landmarks.size(), a.landmarks.size() + b.landmarks.size()) << "some are in both";
  for (const Landmark& object : joined->map.landmarks) {
    EXPECT_GE(object.covariance(0, 0), 0.01 - 1e-9) << object.id.value;
    EXPECT_EQ(object.observations, 10) << object.id.value;
  }
}

TEST(MapsOfPieces, ObjectsAndWallsCorrectThePaths) {
  const Pose2 b_from_world{1, -2, 0.7};
  const auto joined =
      unitedPieces(pieceMap({}, 0, 30, true), pieceMap(b_from_world, 20, 50, false, {0.15, 0.1, 0.02}));
  ASSERT_TRUE(joined) << joined.reason();
  EXPECT_TRUE(joined->by_maps);
  EXPECT_LT(worstPlace(joined->map), 0.05);
  EXPECT_GT(apart(joined->paths.a_from_b, b_from_world.inverse()), 0.1);
}

TEST(MapsOfPieces, PathsDecideWhereMapsDoNot) {
  const Pose2 b_from_world{1, -2, 0.7};
  const auto far =
      unitedPieces(pieceMap({}, 0, 30, true), pieceMap(b_from_world, 20, 50, false, {1.5, 0, 0}));
  ASSERT_TRUE(far) << far.reason();
  EXPECT_FALSE(far->by_maps) << "they contradict the common path";
  EXPECT_EQ(far->why_not, "objects and walls would put it elsewhere");
  EXPECT_LT(apart(far->a_from_b, far->paths.a_from_b), 1e-12);
  auto empty_a = pieceMap({}, 0, 30, true), empty_b = pieceMap(b_from_world, 20, 50, false);
  for (auto* map : {&empty_a, &empty_b}) {
    map->occupancy.reset();
    map->landmarks.clear();
  }
  const auto blind = unitedPieces(empty_a, empty_b);
  ASSERT_TRUE(blind) << blind.reason();
  EXPECT_FALSE(blind->by_maps);
  EXPECT_NE(blind->why_not, "");
  EXPECT_LT(apart(blind->a_from_b, b_from_world.inverse()), 1e-9);
  EXPECT_FALSE(unitedPieces(pieceMap({}, 0, 10, true), pieceMap({}, 20, 50, false)));
}

}  // namespace
}  // namespace roomgraph::test
