// SPDX-License-Identifier: BSD-3-Clause
// LandmarkMap: fusion, existence, merging and splitting against values worked out by hand.
#include "roomgraph/association/landmark_map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "roomgraph/core/config.h"
#include "sightings.h"

namespace roomgraph::test {
namespace {

LandmarkMap mapWith(const std::string& config) {
  LandmarkOptions options;
  Config::fromText("[landmarks]\n" + config).read("landmarks", options);
  return LandmarkMap(options);
}

LandmarkId born(LandmarkMap& map, const WorldMeasurement& seen) {
  return map.update(seen, belongsTo({}));
}

TEST(LandmarkMap, FirstSightingMakesALandmark) {
  LandmarkMap map = mapWith("birth_existence = 0.4");
  const LandmarkId first = born(map, sightingAt(1, 2, 0.5, 0.2)), second = born(map, sightingAt(4, 2));
  EXPECT_NE(first, second);
  ASSERT_EQ(map.landmarks().size(), 2u);
  const Landmark* landmark = map.find(first);
  ASSERT_TRUE(landmark);
  EXPECT_EQ(landmark->class_name, "chair");
  EXPECT_EQ(landmark->position, Eigen::Vector3d(1, 2, 0));
  EXPECT_NEAR(landmark->yaw, 0.5, 1e-12);
  EXPECT_TRUE(landmark->has_yaw);
  EXPECT_DOUBLE_EQ(landmark->covariance(0, 0), 0.04);
  EXPECT_DOUBLE_EQ(landmark->existence, 0.4);
  EXPECT_EQ(landmark->observations, 1);
  EXPECT_EQ(map.find(LandmarkId{99}), nullptr);
}

TEST(LandmarkMap, WhatRaysSaidOfAFormerPlaceIsForgotten) {
  LandmarkMap map = mapWith("birth_existence = 0.4");
  const LandmarkId id = born(map, sightingAt(1, 2)), same = born(map, sightingAt(2, 2));
  for (int i = 0; i < 9; ++i) map.supported(id, 20);
  const double most = map.find(id)->existence;
  map.supported(id, 20);
  ASSERT_EQ(map.find(id)->existence, most) << "returns support only so much";
  const double variance = map.find(id)->covariance(0, 0);
  map.setMoved(id, same, {1.6, 2});
  ASSERT_EQ(map.landmarks().size(), 1u);
  EXPECT_EQ(map.identity().today(same), id);
  EXPECT_EQ(map.find(id)->position, Eigen::Vector3d(1.6, 2, 0));
  EXPECT_GT(map.find(id)->covariance(0, 0), variance);
  const double joined = map.find(id)->existence;
  map.supported(id, 20);
  EXPECT_GT(map.find(id)->existence, joined) << "where it stands now";
}

// Independent axes: after n sightings the place is the mean weighted with 1 / sigma^2, the variance 1 / sum
// of these.
TEST(LandmarkMap, PlaceIsTheWeightedMeanOfItsSightings) {
  LandmarkMap map;
  const double x[] = {1.0, 1.12, 0.95}, sigma[] = {0.2, 0.1, 0.15};
  const LandmarkId id = born(map, sightingAt(x[0], 0, 0, sigma[0]));
  double weights = 1 / (sigma[0] * sigma[0]), sum = weights * x[0];
  for (int i : {1, 2}) {
    EXPECT_EQ(map.update(sightingAt(x[i], 0, 0, sigma[i]), belongsTo(id)), id);
    const double weight = 1 / (sigma[i] * sigma[i]);
    weights += weight;
    sum += weight * x[i];
    EXPECT_NEAR(map.find(id)->position.x(), sum / weights, 1e-12);
    EXPECT_NEAR(map.find(id)->covariance(0, 0), 1 / weights, 1e-12);
  }
  EXPECT_EQ(map.find(id)->observations, 3);
  EXPECT_EQ(map.landmarks().size(), 1u);
}

TEST(LandmarkMap, VarianceNeverFallsBelowAFloor) {
  LandmarkMap map;
  const LandmarkId id = born(map, sightingAt(0, 0, 0, 0.05));
  for (int i = 0; i < 200; ++i) map.update(sightingAt(0, 0, 0, 0.05), belongsTo(id));
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(map.find(id)->covariance(i, i), 1e-4, 1e-12);
}

TEST(LandmarkMap, YawIsFusedAcrossTheWrap) {
  LandmarkMap map;
  const LandmarkId id = born(map, sightingAt(0, 0, 3.1));
  map.update(sightingAt(0, 0, -3.1), belongsTo(id));
  EXPECT_NEAR(std::abs(map.find(id)->yaw), M_PI, 1e-9);  // half way, through pi
}

TEST(LandmarkMap, OppositeReadingOfTheYawChangesNothing) {
  LandmarkMap map;
  const LandmarkId id = born(map, sightingAt(0, 0, 0.3));
  map.update(sightingAt(0, 0, 0.3 + M_PI), belongsTo(id));
  EXPECT_NEAR(map.find(id)->yaw, 0.3, 1e-9);
  EXPECT_NEAR(map.find(id)->covariance(3, 3), 0.01, 1e-6) << "no information about the yaw";
  EXPECT_NEAR(map.find(id)->covariance(0, 0), 0.005, 1e-9) << "but about the place";
}

TEST(LandmarkMap, YawComesWithTheFirstSightingThatHasOne) {
  LandmarkMap map;
  WorldMeasurement round = sightingAt(0, 0, 0);
  round.measurement.proposal.has_yaw = false;
  const LandmarkId id = born(map, round);
  EXPECT_FALSE(map.find(id)->has_yaw);
  map.update(sightingAt(0, 0, 1.2), belongsTo(id));
  EXPECT_TRUE(map.find(id)->has_yaw);
  EXPECT_NEAR(map.find(id)->yaw, 1.2, 1e-12);
  EXPECT_NEAR(map.find(id)->covariance(3, 3), 0.01, 1e-12);
}

TEST(LandmarkMap, SizeIsTheMeanOfItsSightings) {
  LandmarkMap map;
  WorldMeasurement wide = sightingAt(0, 0), narrow = sightingAt(0, 0);
  wide.measurement.proposal.shape.width = 0.8;
  narrow.measurement.proposal.shape.width = 0.5;
  const LandmarkId id = born(map, wide);
  map.update(narrow, belongsTo(id));
  map.update(narrow, belongsTo(id));
  EXPECT_NEAR(map.find(id)->shape.width, (0.8 + 0.5 + 0.5) / 3, 1e-12);
  EXPECT_NEAR(map.find(id)->shape.height, 0.9, 1e-12);
}

// Prior 0.5; a sighting of full score speaks 4 to 1 for the object (exp(gain) = 4), a miss 4 to 1 against it:
// p(none | object) = 0.2, p(none | nothing) = 0.8.
const std::string kFourToOne =
    "birth_existence = 0.5\nscore_gain = 1.3862943611198906\nneutral_score = 0\ndetection_probability = 0.8\n"
    "false_alarm_probability = 0.2\n";

TEST(LandmarkMap, ExistenceFollowsBayesRule) {
  LandmarkMap map = mapWith(kFourToOne);
  const LandmarkId id = born(map, sightingAt(0, 0));
  map.update(sightingAt(0, 0), belongsTo(id));
  EXPECT_NEAR(map.find(id)->existence, 4.0 / 5, 1e-12);
  map.update(sightingAt(0, 0), belongsTo(id));
  EXPECT_NEAR(map.find(id)->existence, 16.0 / 17, 1e-12);
  map.miss(id);
  EXPECT_NEAR(map.find(id)->existence, 4.0 / 5, 1e-12) << "a miss takes back one sighting";
  map.miss(id);
  map.miss(id);
  EXPECT_NEAR(map.find(id)->existence, 1.0 / 5, 1e-12);
  for (int i = 0; i < 50; ++i) map.miss(id);
  EXPECT_NEAR(map.find(id)->existence, 0.01, 1e-12) << "may come back";
  for (int i = 0; i < 50; ++i) map.update(sightingAt(0, 0), belongsTo(id));
  EXPECT_LT(map.find(id)->existence, 1) << "may be gone";
  map.miss(LandmarkId{77});  // unknown: nothing happens
}

TEST(LandmarkMap, PoorSightingSpeaksAgainstTheObject) {
  LandmarkMap map = mapWith("birth_existence = 0.5\nscore_gain = 2\nneutral_score = 0.4\n");
  WorldMeasurement poor = sightingAt(0, 0), neutral = sightingAt(0, 0);
  poor.measurement.proposal.score = 0.1;
  neutral.measurement.proposal.score = 0.4;
  const LandmarkId id = born(map, poor);
  map.update(neutral, belongsTo(id));
  EXPECT_NEAR(map.find(id)->existence, 0.5, 1e-12);
  map.update(poor, belongsTo(id));
  // 2 (.1 - .4), of which .1 / .4 counts.
  EXPECT_NEAR(map.find(id)->existence, std::exp(-0.15) / (1 + std::exp(-0.15)), 1e-12);
  poor.measurement.proposal.score = 0;
  const double existence = map.find(id)->existence;
  map.update(poor, belongsTo(id));
  EXPECT_DOUBLE_EQ(map.find(id)->existence, existence) << "nothing but a box was seen";
}

TEST(LandmarkMap, VagueSightingsAndThoseElsewhereSayNothingOfExistence) {
  LandmarkMap map;
  const LandmarkId id = born(map, sightingAt(0, 0, 0, 0.05));
  const double existence = map.find(id)->existence;
  map.update(sightingAt(3, 0, 0, 0.05), belongsTo(id));
  EXPECT_DOUBLE_EQ(map.find(id)->existence, existence);
  LandmarkMap vague;
  const LandmarkId far = born(vague, sightingAt(0, 0, 0, 3));
  vague.update(sightingAt(0, 0, 0, 3), belongsTo(far));
  LandmarkMap precise;
  const LandmarkId near = born(precise, sightingAt(0, 0, 0, 0.1));
  precise.update(sightingAt(0, 0, 0, 0.1), belongsTo(near));
  // .3^2 over the trace 2 * 3^2: one half of a hundredth of the precise one's log odds.
  const auto log_odds = [](double p) { return std::log(p / (1 - p)); };
  EXPECT_NEAR((log_odds(vague.find(far)->existence) - log_odds(existence)) /
                  (log_odds(precise.find(near)->existence) - log_odds(existence)),
              0.005, 1e-9);
}

TEST(LandmarkMap, ConfirmedNeedsExistenceAndSightings) {
  LandmarkMap map = mapWith(kFourToOne + "confirm_existence = 0.9\nconfirm_observations = 3");
  const LandmarkId id = born(map, sightingAt(0, 0));
  map.update(sightingAt(0, 0), belongsTo(id));
  EXPECT_TRUE(map.confirmed().empty()) << "two sightings";
  map.update(sightingAt(0, 0), belongsTo(id));
  ASSERT_EQ(map.confirmed().size(), 1u);
  EXPECT_EQ(map.confirmed()[0].id, id);
  map.miss(id);
  map.miss(id);
  EXPECT_TRUE(map.confirmed().empty()) << "existence " << map.find(id)->existence;
}

// Footprints of 0.6 x 0.6 m, 0.3 m apart: half of each lies under the other.
TEST(LandmarkMap, OfTwoThingsInOnePlaceTheBetterSeenIsConfirmed) {
  const std::string easy = "confirm_existence = 0\nconfirm_observations = 1\nexclusive_overlap = ";
  for (const auto& [limit, expected] : {std::pair{"0.49", 2u}, std::pair{"0.51", 3u}}) {
    LandmarkMap map = mapWith(easy + limit);
    const LandmarkId chair = born(map, sightingAt(0, 0)),
                     sofa = born(map, sightingAt(0.3, 0, 0, 0.1, "sofa")),
                     apart = born(map, sightingAt(2, 0));
    map.update(sightingAt(0.3, 0, 0, 0.1, "sofa"), belongsTo(sofa));
    const auto kept = map.confirmed();
    ASSERT_EQ(kept.size(), expected) << limit;
    EXPECT_EQ(kept.front().id, expected == 3 ? chair : sofa);
    EXPECT_EQ(kept[kept.size() - 2].id, sofa);
    EXPECT_EQ(kept.back().id, apart);
    EXPECT_EQ(map.landmarks().size(), 3u) << "the other one may still win";
  }
}

TEST(LandmarkMap, OverlappingLandmarksOfOneClassBecomeOne) {
  LandmarkMap map = mapWith("merge_overlap = 0.3\nbirth_existence = 0.5");
  const LandmarkId first = born(map, sightingAt(0, 0)), second = born(map, sightingAt(0.2, 0)),
                   door = born(map, sightingAt(0, 0, 0, 0.1, "door")), far = born(map, sightingAt(0.9, 0));
  map.update(sightingAt(0.2, 0), belongsTo(second));
  const double existence = map.find(second)->existence;
  const auto merged = map.mergeDuplicates();
  ASSERT_EQ(merged.size(), 1u);
  EXPECT_EQ(merged[0], std::make_pair(second, first));
  EXPECT_EQ(map.find(second), nullptr);
  EXPECT_TRUE(map.find(door) && map.find(far));
  const Landmark* kept = map.find(first);
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->observations, 3);
  EXPECT_NEAR(kept->existence, 1 - 0.5 * (1 - existence), 1e-12);
  EXPECT_NEAR(kept->position.x(), 0.2, 1e-12) << "the one seen more often says where";
  EXPECT_TRUE(map.mergeDuplicates().empty());
}

TEST(LandmarkMap, CorrectionSetsWhatTheGraphFound) {
  LandmarkMap map;
  const LandmarkId id = born(map, sightingAt(0, 0));
  map.correct(id, {1, 2, 3}, 0.4, {ShapeKind::kCuboid, 1.5, 0.8, 0.7}, 0.5 * Eigen::Matrix4d::Identity());
  EXPECT_EQ(map.find(id)->position, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(map.find(id)->yaw, 0.4);
  EXPECT_EQ(map.find(id)->shape.width, 1.5);
  EXPECT_EQ(map.find(id)->shape.height, 0.7);
  EXPECT_EQ(map.find(id)->covariance(2, 2), 0.5);
}

WorldMeasurement inFrame(WorldMeasurement seen, std::int64_t frame) {
  seen.measurement.frame = FrameId{frame};
  return seen;
}

// Half a width apart: one object when seen in turns, two when seen together.
TEST(LandmarkMap, NeighboursSeenTogetherStayApart) {
  for (const bool together : {false, true}) {
    LandmarkMap map;
    const LandmarkId a = born(map, inFrame(sightingAt(0, 0), 0));
    const LandmarkId b = born(map, inFrame(sightingAt(0.33, 0), together ? 0 : 1));
    for (int i = 1; i < 10; ++i) {
      map.update(inFrame(sightingAt(0, 0), 2 * i), belongsTo(a));
      map.update(inFrame(sightingAt(0.33, 0), 2 * i + !together), belongsTo(b));
    }
    EXPECT_EQ(map.mergeDuplicates().size(), together ? 0u : 1u);
  }
}

// A chair of 0.6 x 0.6 m reaches 0.2 m under a table: a third of its footprint.
TEST(LandmarkMap, ChairsUnderATableAreInTheMapWhereFramesShowBoth) {
  for (const double gap : {0.5, 0.35})
    for (const bool together : {false, true}) {
      LandmarkMap map = mapWith("confirm_existence = 0\nconfirm_observations = 1");
      WorldMeasurement table = sightingAt(0, 0, 0, 0.1, "table"), chair = sightingAt(gap, 0);
      table.measurement.proposal.shape = {ShapeKind::kCuboid, 1.4, 0.8, 0.74};
      const LandmarkId a = born(map, inFrame(table, 0)), b = born(map, inFrame(chair, together ? 0 : 1));
      for (int i = 1; i < 10; ++i) {
        map.update(inFrame(table, 2 * i), belongsTo(a));
        map.update(inFrame(chair, 2 * i + !together), belongsTo(b));
      }
      EXPECT_EQ(map.confirmed().size(), together && gap > 0.4 ? 2u : 1u) << gap << ' ' << together;
    }
}

TEST(LandmarkMap, TwoGroupsOfSightingsAreTwoObjects) {
  LandmarkMap map;
  const LandmarkId mixed = born(map, sightingAt(0, 0));
  for (int i = 1; i < 20; ++i)
    map.update(sightingAt(i % 2 ? 0.02 * (i % 5) : 0.7 + 0.02 * (i % 5), 0), belongsTo(mixed));
  const auto split_pairs = map.splitMixed();
  ASSERT_EQ(split_pairs.size(), 1u);
  EXPECT_EQ(split_pairs[0].first, mixed);
  const Landmark *a = map.find(mixed), *b = map.find(split_pairs[0].second);
  ASSERT_TRUE(a && b);
  EXPECT_NEAR(std::abs(a->position.x() - b->position.x()), 0.7, 0.05);
  EXPECT_EQ(a->observations + b->observations, 20);
  EXPECT_TRUE(map.splitMixed().empty());
}

TEST(LandmarkMap, AMovedLandmarkIsPartedWhereItsSightingsWent) {
  LandmarkMap map;
  const LandmarkId mixed = born(map, sightingAt(0, 0));
  for (int i = 1; i < 20; ++i)
    map.update(sightingAt(i % 2 ? 0.02 * (i % 5) : 0.7 + 0.02 * (i % 5), 0), belongsTo(mixed));
  map.move(mixed, poseFromYpr(4, 1, 0, M_PI / 2, 0, 0));
  const auto split_pairs = map.splitMixed();
  ASSERT_EQ(split_pairs.size(), 1u);
  const Landmark *a = map.find(mixed), *b = map.find(split_pairs[0].second);
  EXPECT_NEAR(std::abs(a->position.y() - b->position.y()), 0.7, 0.05);
  EXPECT_NEAR(a->position.x(), 4, 0.05);
  EXPECT_NEAR(b->position.x(), 4, 0.05);
}

TEST(LandmarkMap, OneGroupIsOneObject) {
  LandmarkMap map;
  const LandmarkId id = born(map, sightingAt(0, 0));
  for (int i = 1; i < 20; ++i) map.update(sightingAt(0.3 * std::sin(i), 0.3 * std::cos(i)), belongsTo(id));
  EXPECT_TRUE(map.splitMixed().empty());
}

// exp(-0.1) a ray; at most twenty rays of a scan count.
TEST(LandmarkMap, RaysSpeakForAndAgainst) {
  LandmarkMap map = mapWith("birth_existence = 0.5\nray_gain = 0.1");
  const LandmarkId id = born(map, sightingAt(0, 0));
  map.seenThrough(id, 10);
  EXPECT_NEAR(map.find(id)->existence, 1 / (1 + std::exp(1.0)), 1e-12);
  map.supported(id, 10);
  EXPECT_NEAR(map.find(id)->existence, 0.5, 1e-12);
  map.seenThrough(id, 1000);
  EXPECT_NEAR(map.find(id)->existence, 1 / (1 + std::exp(2.0)), 1e-12);
  map.seenThrough(LandmarkId{77}, 3);  // unknown: nothing happens
}

TEST(LandmarkMap, FrontIsDecidedByVote) {
  LandmarkMap map;
  const LandmarkId id = born(map, sightingAt(0, 0, 0.3));
  for (int i = 0; i < 3; ++i) map.update(sightingAt(0, 0, 0.3 + M_PI), belongsTo(id));
  EXPECT_NEAR(map.find(id)->yaw, wrapAngle(0.3 + M_PI), 1e-6);
  for (int i = 0; i < 6; ++i) map.update(sightingAt(0, 0, 0.3), belongsTo(id));
  EXPECT_NEAR(map.find(id)->yaw, 0.3, 1e-6);
}

TEST(LandmarkMap, LabelsVoteForTheClass) {
  LandmarkMap map;
  const LandmarkId id = born(map, sightingAt(0, 0));
  const WorldMeasurement sofa = sightingAt(1, 0, 0, 0.1, "sofa");
  map.update(sofa, belongsTo(id));
  EXPECT_EQ(map.find(id)->class_name, "chair");
  EXPECT_EQ(map.find(id)->position.x(), 0) << "another class says nothing about the place";
  EXPECT_NEAR(map.find(id)->class_posterior.at("chair"), 0.5, 1e-12);
  for (int i = 0; i < 3; ++i) map.update(sofa, belongsTo(id));
  EXPECT_EQ(map.find(id)->class_name, "sofa");
  EXPECT_EQ(map.find(id)->position.x(), 1);
  EXPECT_NEAR(map.find(id)->class_posterior.at("sofa"), 4.5 / 6, 1e-12);
}

TEST(LandmarkMap, CutAndCarriedBoxesCountLess) {
  LandmarkMap map;
  WorldMeasurement wide = sightingAt(0, 0), cut = sightingAt(0, 0);
  wide.measurement.proposal.shape.width = 1;
  cut.measurement.proposal.shape.width = 0.4;
  cut.measurement.proposal.projected.full = {0, 0, 100, 100};
  cut.measurement.proposal.projected.visible = {0, 0, 50, 100};
  const LandmarkId id = born(map, wide);
  map.update(cut, belongsTo(id));
  EXPECT_NEAR(map.find(id)->shape.width, (1 + 0.5 * 0.4) / 1.5, 1e-12);
  LandmarkMap other = mapWith("birth_existence = 0.5\nscore_gain = 1\nneutral_score = 0");
  const LandmarkId seen = born(other, sightingAt(0, 0));
  WorldMeasurement carried = sightingAt(0, 0);
  carried.measurement.detection.carried = true;
  other.update(carried, belongsTo(seen));
  EXPECT_NEAR(other.find(seen)->existence, 1 / (1 + std::exp(-0.3)), 1e-12);
}

}  // namespace
}  // namespace roomgraph::test
