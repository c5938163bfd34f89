// SPDX-License-Identifier: BSD-3-Clause
// LandmarkMap: outliers, carried boxes, limits of beams, votes and doubts through corrections, moves and hindsight.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "roomgraph/association/landmark_map.h"
#include "sightings.h"

namespace roomgraph::test {
namespace {

// Variance of a Kalman filter's measurement that moves an estimate of variance p from 0 to x when it says z.
double impliedVariance(double p, double z, double x) {
  return p * z / x - p;
}

TEST(LandmarkEvidence, ASightingFarOffIsDoubtedWithTheFourthPowerOfItsDistance) {
  const double variance = 0.01;
  for (const double z : {0.5, 1.0, 2.0}) {
    LandmarkMap map;
    const LandmarkId id = map.update(sightingAt(0, 0), belongsTo({}));
    map.update(sightingAt(z, 0), belongsTo(id));
    const double squared = z * z / (2 * variance);  // Mahalanobis; 16 and less are no outliers
    const double doubt = squared > 16 ? std::pow(squared / 16, 2) : 1;
    EXPECT_NEAR(impliedVariance(variance, z, map.find(id)->position.x()), doubt * variance, 1e-9) << z;
  }
}

TEST(LandmarkEvidence, ACarriedBoxMeasuresThePlaceWithLessInformation) {
  LandmarkMap map;
  const LandmarkId id = map.update(sightingAt(0, 0), belongsTo({}));
  WorldMeasurement carried = sightingAt(0.2, 0);
  carried.measurement.detection.carried = true;
  map.update(carried, belongsTo(id));
  EXPECT_NEAR(impliedVariance(0.01, 0.2, map.find(id)->position.x()), 0.01 / 0.3, 1e-9);
}

// Something stands there, which need not be this object: the odds grow by a factor of e at most.
TEST(LandmarkEvidence, BeamsThatEndInsideConvinceOnlySoFar) {
  LandmarkOptions options;
  options.rules.birth_existence = 0.5;
  LandmarkMap map(options);
  const LandmarkId id = map.update(sightingAt(0, 0), belongsTo({}));
  map.supported(id, 6);
  EXPECT_NEAR(map.find(id)->existence, 1 / (1 + std::exp(-0.6)), 1e-12);
  for (int scan = 0; scan < 3; ++scan) map.supported(id, 1000);
  EXPECT_NEAR(map.find(id)->existence, 1 / (1 + std::exp(-1.0)), 1e-12);
}

TEST(LandmarkEvidence, AMovedLandmarkTakesItsCovarianceAlong) {
  LandmarkMap map;
  WorldMeasurement seen = sightingAt(2, 1, 0.4);
  seen.covariance.diagonal() << 0.09, 0.01, 0.0004, 0.2;
  seen.covariance(0, 1) = seen.covariance(1, 0) = 0.02;
  const LandmarkId id = map.update(seen, belongsTo({}));
  map.move(id, poseFromYpr(5, -3, 0, M_PI / 2, 0, 0));
  const Landmark& landmark = *map.find(id);
  EXPECT_LT((landmark.position - Eigen::Vector3d(4, -1, 0)).norm(), 1e-12);
  EXPECT_NEAR(landmark.yaw, 0.4 + M_PI / 2, 1e-12);
  EXPECT_NEAR(landmark.covariance(0, 0), 0.01, 1e-12);
  EXPECT_NEAR(landmark.covariance(1, 1), 0.09, 1e-12);
  EXPECT_NEAR(landmark.covariance(0, 1), -0.02, 1e-12);
  EXPECT_NEAR(landmark.covariance(3, 3), 0.2, 1e-12);
}

// Three sightings said that the front is at 0. The graph turned the landmark round: the next one outvotes that.
TEST(LandmarkEvidence, ATurnedLandmarkKeepsTheVotesOfItsSightings) {
  LandmarkMap map;
  const LandmarkId id = map.update(sightingAt(0, 0), belongsTo({}));
  for (int i = 0; i < 2; ++i) map.update(sightingAt(0, 0), belongsTo(id));
  const Landmark before = *map.find(id);
  map.correct(id, before.position, M_PI, before.shape, before.covariance);
  map.update(sightingAt(0, 0), belongsTo(id));
  EXPECT_NEAR(std::abs(map.find(id)->yaw), 0, 1e-6);
}

WorldMeasurement sightingIn(int frame) {
  WorldMeasurement seen = sightingAt(1, 1);
  seen.measurement.frame = FrameId{frame};
  seen.measurement.t = frame;
  seen.measurement.proposal.score = 0.9;
  return seen;
}

// Seen once, missed sixty times, seen three times again. In hindsight the evidence is weighed in this order:
// the existence falls to its floor of .01, and three sightings of score .9 lift the odds by exp(5 (.9 - .2))
// each.
TEST(LandmarkEvidence, HindsightWeighsDoubtsAtTheirTime) {
  LandmarkMap map;
  std::vector<std::vector<WorldMeasurement>> frames;
  LandmarkId id;
  for (int frame = 0; frame < 4; ++frame) {
    const WorldMeasurement seen = sightingIn(frame);
    frames.push_back({seen});
    id = map.update(seen, belongsTo(id));
    if (frame == 0)
      for (int i = 0; i < 60; ++i) map.miss(id);
  }
  const double odds = 0.01 / 0.99 * std::exp(3 * 5 * (0.9 - 0.2));
  EXPECT_NEAR(map.find(id)->existence, odds / (1 + odds), 1e-9);
  const Reassociation result = reassociate(frames, map.landmarks(), map.identity(), AssociationModel{}, map.rules());
  ASSERT_EQ(result.landmarks.size(), 1u);
  map.adopt(frames, result);
  EXPECT_NEAR(map.find(result.landmarks[0].id)->existence, odds / (1 + odds), 1e-9);
}

// What a sighting is known by still when it is given up.
FormerSighting formerOf(const LandmarkMap& map, const WorldMeasurement& seen, LandmarkId landmark) {
  return {.t = seen.measurement.t,
          .frame = seen.measurement.frame,
          .class_name = seen.measurement.proposal.class_name,
          .landmark = landmark,
          .existence_log_ratio = map.existenceLogRatio(landmark, seen),
          .weight = sightingWeight(seen.measurement)};
}

// As above, but two of the sightings are given up.
TEST(LandmarkEvidence, HindsightWeighsFormerSightingsAtTheirTime) {
  LandmarkMap map;
  std::vector<std::vector<WorldMeasurement>> kept;
  std::vector<FormerSighting> former;
  LandmarkId id;
  for (int frame = 0; frame < 4; ++frame) {
    const WorldMeasurement seen = sightingIn(frame);
    id = map.update(seen, belongsTo(id));
    if (frame == 0)
      for (int i = 0; i < 60; ++i) map.miss(id);
    if (frame % 3 == 0)
      kept.push_back({seen});
    else
      former.push_back(formerOf(map, seen, id));
  }
  EXPECT_NEAR(former[0].existence_log_ratio, 5 * (0.9 - 0.2), 1e-12);
  EXPECT_EQ(map.existenceLogRatio(LandmarkId{99}, kept[0][0]), 0);
  WorldMeasurement of_another_class = kept[0][0];
  of_another_class.measurement.proposal.class_name = "bench";
  EXPECT_EQ(map.existenceLogRatio(id, of_another_class), 0);
  const double odds = 0.01 / 0.99 * std::exp(3 * 5 * (0.9 - 0.2)), weight = map.weightOf(id);
  const Reassociation result = reassociate(kept, map.landmarks(), map.identity(), AssociationModel{}, map.rules());
  ASSERT_EQ(result.landmarks.size(), 1u);
  for (int again = 0; again < 2; ++again) {
    map.adopt(kept, result, former);
    EXPECT_NEAR(map.find(id)->existence, odds / (1 + odds), 1e-9) << again;
    EXPECT_EQ(map.find(id)->observations, 4);
    EXPECT_NEAR(map.weightOf(id), weight, 1e-12);
  }
}

// The first, distant glimpse of a chair was called a sofa: it is one label of several, though the first in time.
TEST(LandmarkEvidence, HindsightDecidesTheClassByAllLabelsAndNotByTheFirst) {
  for (const bool mostly_sofa : {false, true}) {
    LandmarkMap map;
    std::vector<std::vector<WorldMeasurement>> frames;
    Reassociation result;
    result.landmarks = {landmarkAt(1, 1, 1)};
    result.identity.reserve(LandmarkId{1});
    for (int frame = 0; frame < 6; ++frame) {
      WorldMeasurement seen = sightingIn(frame);
      if (mostly_sofa ? frame != 3 : frame == 0) {
        seen.measurement.proposal.class_name = "sofa";
        seen.world_from_object.translation().x() = 1.3;
      }
      frames.push_back({seen});
      result.decisions.push_back({{.association = belongsTo(LandmarkId{1}), .landmark = LandmarkId{1}}});
    }
    map.adopt(frames, result);
    ASSERT_EQ(map.landmarks().size(), 1u);
    const Landmark& landmark = map.landmarks()[0];
    EXPECT_EQ(landmark.class_name, mostly_sofa ? "sofa" : "chair");
    EXPECT_EQ(landmark.observations, 5) << "of its class";
    EXPECT_NEAR(landmark.position.x(), mostly_sofa ? 1.3 : 1, 1e-9);
    EXPECT_NEAR(landmark.class_posterior.at(landmark.class_name), (5 * 0.9 + 1) / (6 * 0.9 + 2), 0.1);
  }
}

// Two chairs so near to each other that only seeing both at once tells them apart. Most of these sightings are given up.
TEST(LandmarkEvidence, HindsightKnowsWhoWasSeenTogetherInFormerSightings) {
  LandmarkMap map;
  std::vector<std::vector<WorldMeasurement>> kept;
  std::vector<FormerSighting> former;
  Reassociation result;
  result.landmarks = {landmarkAt(1, 1, 1), landmarkAt(2, 1.3, 1)};
  result.identity.reserve(LandmarkId{2});
  for (int frame = 0; frame < 200; ++frame)
    for (const int id : {1, 2}) {
      WorldMeasurement seen = sightingIn(frame);
      seen.world_from_object.translation().x() = id == 1 ? 1 : 1.3;
      if (frame % 40 != 0) {
        former.push_back(formerOf(map, seen, LandmarkId{id}));
      } else {
        if (id == 1) kept.emplace_back(), result.decisions.emplace_back();
        kept.back().push_back(seen);
        result.decisions.back().push_back({.association = belongsTo(LandmarkId{id}), .landmark = LandmarkId{id}});
      }
    }
  map.adopt(kept, result, former);
  EXPECT_TRUE(map.mergeDuplicates().empty());
  for (auto& sighting : former) sighting.landmark = LandmarkId{1 + sighting.frame.value % 2};
  map.adopt(kept, result, former);
  EXPECT_EQ(map.mergeDuplicates().size(), 1u) << "seen in turns they are one";
}

// Former sightings with the label of another class only vote for it.
TEST(LandmarkEvidence, FormerSightingsOfOtherClassesCountNotAsObservations) {
  LandmarkMap map;
  Reassociation result;
  result.landmarks = {landmarkAt(1, 1, 1)};
  result.identity.reserve(LandmarkId{1});
  std::vector<std::vector<WorldMeasurement>> kept;
  std::vector<FormerSighting> former;
  for (int frame = 0; frame < 8; ++frame) {
    WorldMeasurement seen = sightingIn(frame);
    if (frame % 4 == 1) seen.measurement.proposal.class_name = "sofa";
    if (frame % 2 == 1) {
      former.push_back({.t = seen.measurement.t, .frame = seen.measurement.frame, .class_name = seen.measurement.proposal.class_name,
                        .landmark = LandmarkId{1}, .existence_log_ratio = 1, .weight = 0.9});
    } else {
      kept.push_back({seen});
      result.decisions.push_back({{.association = belongsTo(LandmarkId{1}), .landmark = LandmarkId{1}}});
    }
  }
  map.adopt(kept, result, former);
  EXPECT_EQ(map.landmarks()[0].observations, 6);
  EXPECT_NEAR(map.weightOf(LandmarkId{1}), 6 * 0.9, 1e-9);
}

// One object was two landmarks when scans passed through it, or ended in it: their beams count once.
TEST(LandmarkEvidence, BeamsCountOnceForLandmarksThatAreOne) {
  for (const bool through : {false, true}) {
    LandmarkOptions options;
    options.rules.birth_existence = 0.5;
    LandmarkMap map(options);
    const LandmarkId a = map.update(sightingAt(1, 1), belongsTo({})), b = map.update(sightingAt(1.1, 1), belongsTo({}));
    for (const LandmarkId id : {a, b}) through ? map.seenThrough(id, 10) : map.supported(id, 20);
    ASSERT_EQ(map.mergeDuplicates().size(), 1u);
    const std::vector<std::vector<WorldMeasurement>> frames{{sightingAt(1, 1)}, {sightingAt(1, 1)}};
    const Reassociation result = reassociate(frames, map.landmarks(), map.identity(), AssociationModel{}, map.rules());
    ASSERT_EQ(result.landmarks.size(), 1u);
    map.adopt(frames, result);
    const double sightings = 2 * 5 * (1 - 0.2), odds = std::exp(sightings + (through ? -1.0 : 1.0));
    EXPECT_NEAR(map.landmarks()[0].existence, odds / (1 + odds), 1e-9) << through;
    map.supported(map.landmarks()[0].id, 1000);
    EXPECT_NEAR(map.landmarks()[0].existence, through ? 1 / (1 + std::exp(-sightings)) : odds / (1 + odds), 1e-9) << "no more than once";
  }
}

// Scans at different times ended in each of them: together they convince no more than in one.
TEST(LandmarkEvidence, BeamsInLandmarksThatAreOneConvinceOnlySoFar) {
  LandmarkOptions options;
  options.rules.birth_existence = 0.5;
  LandmarkMap map(options);
  std::vector<std::vector<WorldMeasurement>> frames;
  for (int frame = 0; frame < 2; ++frame) {
    WorldMeasurement seen = sightingIn(frame);
    seen.world_from_object.translation().x() += 0.1 * frame;
    map.supported(map.update(seen, belongsTo({})), 20);
    frames.push_back({seen});
  }
  ASSERT_EQ(map.mergeDuplicates().size(), 1u);
  map.adopt(frames, reassociate(frames, map.landmarks(), map.identity(), AssociationModel{}, map.rules()));
  const double odds = std::exp(2 * 5 * (0.9 - 0.2) + 1);
  ASSERT_EQ(map.landmarks().size(), 1u);
  EXPECT_NEAR(map.landmarks()[0].existence, odds / (1 + odds), 1e-9);
}

// A chair was taken for two, of which each was missed when the other one was seen. In hindsight they are one,
// seen in all frames but the last two, and missed once in each of these.
TEST(LandmarkEvidence, HindsightForgetsTheMissesOfWhoeverWasSeen) {
  LandmarkMap map;
  std::vector<std::vector<WorldMeasurement>> frames;
  std::array<LandmarkId, 2> ids;
  for (int frame = 0; frame < 10; ++frame) {
    WorldMeasurement seen = sightingAt(1, 1);
    seen.measurement.frame = FrameId{frame};
    seen.measurement.t = frame;
    seen.measurement.proposal.score = 0.4;
    frames.push_back({seen});
    auto& id = ids[static_cast<std::size_t>(frame % 2)];
    id = map.update(seen, belongsTo(id));
    if (frame > 0) map.miss(ids[static_cast<std::size_t>(1 - frame % 2)], FrameId{frame});
  }
  for (const LandmarkId id : ids)
    for (const int frame : {10, 11}) map.miss(id, FrameId{frame});
  const Reassociation result =
      reassociate(frames, map.landmarks(), map.identity(), AssociationModel{}, map.rules());
  ASSERT_EQ(result.landmarks.size(), 1u);
  LandmarkMap with_former = map;
  map.adopt(frames, result);
  const double birth = map.rules().birth_existence;
  const double odds =
      birth / (1 - birth) * std::exp(10 * 5 * (0.4 - 0.2)) * std::pow((1 - 0.6) / (1 - 0.15), 2);
  EXPECT_NEAR(map.find(result.landmarks[0].id)->existence, odds / (1 + odds), 1e-9);
  // Nor were those missed who are said to be seen where the sightings were given up.
  std::vector<std::vector<WorldMeasurement>> kept;
  std::vector<FormerSighting> former;
  for (const auto& frame : frames) {
    if (frame[0].measurement.t < 3 || frame[0].measurement.t > 7)
      kept.push_back(frame);
    else
      former.push_back(formerOf(map, frame[0], result.landmarks[0].id));
  }
  with_former.adopt(kept, reassociate(kept, result.landmarks, result.identity, AssociationModel{}, map.rules()), former);
  EXPECT_NEAR(with_former.find(result.landmarks[0].id)->existence, odds / (1 + odds), 1e-9);
  map.adopt(frames, result);
  EXPECT_NEAR(map.find(result.landmarks[0].id)->existence, odds / (1 + odds), 1e-9) << "once more";
}

}  // namespace
}  // namespace roomgraph::test
