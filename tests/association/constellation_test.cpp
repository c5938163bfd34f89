// SPDX-License-Identifier: BSD-3-Clause
// Constellation matching over random transforms, noise, ambiguity and missing objects.
#include "roomgraph/association/constellation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "random_poses.h"

namespace roomgraph::test {
namespace {

Landmark object(const std::string& class_name, double x, double y, double yaw = 0, bool has_yaw = false) {
  Landmark landmark;
  landmark.class_name = class_name;
  landmark.position = {x, y, 0};
  landmark.yaw = yaw;
  landmark.has_yaw = has_yaw;
  return landmark;
}

Landmark moved(Landmark landmark, const Pose2& a_from_b) {
  const Eigen::Vector2d place = a_from_b * Eigen::Vector2d(landmark.position.head<2>());
  landmark.position = {place.x(), place.y(), 0};
  landmark.yaw = wrapAngle(landmark.yaw + a_from_b.yaw);
  return landmark;
}

std::vector<Landmark> office() {
  return {object("chair", 1, 2),         object("chair", 4, 2.5), object("sofa", 0.5, 6, 1.2, true),
          object("door", 7, 1, 0, true), object("chair", 6, 5.5), object("sofa", 3, 7.5, -0.4, true)};
}

TEST(Constellation, FindsTheTransformOverRandomMovesNoiseAndStrangers) {
  Random random(11);
  for (int round = 0; round < 40; ++round) {
    const Pose2 map_from_query{random.uniform(-8, 8), random.uniform(-8, 8), random.uniform(-3, 3)};
    const auto map = office();
    std::vector<Landmark> query;
    const int left_out = random.index(static_cast<int>(map.size()));
    for (int i = 0; i < static_cast<int>(map.size()); ++i) {
      if (i == left_out) continue;
      Landmark seen = moved(map[static_cast<std::size_t>(i)], map_from_query.inverse());
      seen.position.head<2>() += Eigen::Vector2d(random.uniform(-.05, .05), random.uniform(-.05, .05));
      query.push_back(seen);
    }
    query.push_back(object("chair", 30, 30));  // was not there before
    const auto match = matchConstellation(query, map);
    ASSERT_TRUE(match) << "round " << round;
    EXPECT_EQ(match->pairs.size(), map.size() - 1);
    const Pose2 error = match->map_from_query.inverse() * map_from_query;
    const Eigen::Vector2d middle = map_from_query.inverse() * Eigen::Vector2d(3.5, 4);
    EXPECT_LT((match->map_from_query * middle - map_from_query * middle).norm(), 0.06);
    EXPECT_LT(std::abs(wrapAngle(error.yaw)), 0.04);
    EXPECT_LT(match->rms_m, 0.08);
  }
}

TEST(Constellation, PairsAreOneToOneAndOfOneClass) {
  const auto map = office();
  auto query = office();
  query.push_back(object("chair", 1.05, 2.05));  // a second chair at the place of the first
  const auto match = matchConstellation(query, map);
  ASSERT_TRUE(match);
  EXPECT_EQ(match->pairs.size(), map.size());
  std::vector<int> used(map.size(), 0);
  for (const auto& [i, k] : match->pairs) {
    EXPECT_EQ(query[i].class_name, map[k].class_name);
    EXPECT_EQ(++used[k], 1);
  }
}

TEST(Constellation, ARowOfEqualChairsFitsInSeveralWays) {
  std::vector<Landmark> row;
  for (int i = 0; i < 6; ++i) row.push_back(object("chair", 1.2 * i, 0));
  const std::vector<Landmark> part(row.begin() + 1, row.begin() + 4);
  EXPECT_FALSE(matchConstellation(part, row));
  // A sofa beside the row says which chairs these are, when the lead is large enough.
  auto marked = row;
  marked.push_back(object("sofa", 2.4, 3));
  auto seen = part;
  seen.push_back(object("sofa", 2.4, 3));
  const auto match = matchConstellation(seen, marked);
  ASSERT_TRUE(match);
  EXPECT_NEAR(match->map_from_query.x, 0, 1e-9);
  EXPECT_NEAR(match->map_from_query.yaw, 0, 1e-9);
  EXPECT_FALSE(matchConstellation(seen, marked, {.min_lead = 2}));
}

TEST(Constellation, TooLittleInCommonIsNoMatch) {
  const auto map = office();
  EXPECT_FALSE(matchConstellation({}, map));
  EXPECT_FALSE(matchConstellation(map, {}));
  EXPECT_FALSE(matchConstellation({map[0], map[2]}, map));
  EXPECT_FALSE(matchConstellation({map[0], map[0], map[0]}, map)) << "three at one place fix no direction";
  auto others = map;
  for (auto& landmark : others) landmark.class_name = "plant";
  EXPECT_FALSE(matchConstellation(others, map));
}

// Of more than fifteen objects those propose transforms whose classes are rarest; all of them vote.
TEST(Constellation, AHallOfChairsIsFoundByItsDoors) {
  Random random(5);
  std::vector<Landmark> map;
  for (int i = 0; i < 60; ++i) map.push_back(object("chair", random.uniform(0, 20), random.uniform(0, 20)));
  for (const auto& [x, y] : {std::pair{0.0, 3.0}, {20.0, 11.0}, {7.0, 20.0}}) map.push_back(object("door", x, y));
  const Pose2 map_from_query{3, -2, 2.5};
  std::vector<Landmark> query;
  for (std::size_t i = 30; i < map.size(); ++i) query.push_back(moved(map[i], map_from_query.inverse()));
  const std::size_t common = query.size();
  for (int i = 0; i < 20; ++i) query.push_back(object("plant", random.uniform(0, 20), random.uniform(0, 20)));  // none in the map
  const auto match = matchConstellation(query, map);
  ASSERT_TRUE(match);
  EXPECT_EQ(match->pairs.size(), common);
  EXPECT_LT(match->rms_m, 1e-6);
  EXPECT_NEAR(match->map_from_query.yaw, 2.5, 1e-6);
}

// All chairs were taken elsewhere, the doors are where they were.
TEST(Constellation, AHallWithOtherChairsIsFoundByItsDoors) {
  Random random(6);
  std::vector<Landmark> map, query;
  const Pose2 map_from_query{3, -2, 2.5};
  for (int i = 0; i < 25; ++i) map.push_back(object("chair", random.uniform(0, 60), random.uniform(0, 60)));
  for (int i = 0; i < 25; ++i) query.push_back(object("chair", random.uniform(200, 260), random.uniform(0, 60)));
  for (int i = 0; i < 8; ++i) {
    map.push_back(object("door", random.uniform(0, 20), random.uniform(0, 20)));
    query.push_back(moved(map.back(), map_from_query.inverse()));
  }
  const auto match = matchConstellation(query, map);
  ASSERT_TRUE(match);
  EXPECT_GE(match->pairs.size(), 8u);
  EXPECT_NEAR(match->map_from_query.yaw, 2.5, 0.05);
}

TEST(Constellation, FrontsMustAgreeUpToHalfATurn) {
  auto map = office();
  auto query = map;
  query[2].yaw += std::acos(-1.0);  // a sofa's front is easily taken for its back
  const auto flipped = matchConstellation(query, map);
  ASSERT_TRUE(flipped);
  EXPECT_EQ(flipped->pairs.size(), map.size());
  query[2].yaw += 1.2;
  const auto turned = matchConstellation(query, map);
  ASSERT_TRUE(turned);
  EXPECT_EQ(turned->pairs.size(), map.size() - 1);
}

}  // namespace
}  // namespace roomgraph::test
