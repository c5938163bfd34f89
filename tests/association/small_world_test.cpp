// SPDX-License-Identifier: BSD-3-Clause
// Associators, landmark map and re-association together on small simulated worlds.
#include "small_world.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "maximum_likelihood_associator.h"
#include "nearest_neighbor_associator.h"
#include "roomgraph/association/association_model.h"
#include "soft_associator.h"

namespace roomgraph::test {
namespace {

constexpr unsigned kSeeds = 8;

template <class Kind>
AssociationErrors errorsOf(const SmallWorld& world) {
  Kind associator;
  LandmarkMap map;
  return evaluateAssociations(world.truth, runOnline(world, associator, map));
}

// Pools several seeds: the mean of accuracies and of the gaps per bin.
struct Pooled {
  double accuracy = 0;
  std::array<double, 10> count{}, probability{}, right{};

  void add(const AssociationErrors& errors) {
    accuracy += errors.accuracy / kSeeds;
    for (std::size_t i = 0; i < 10; ++i) {
      const auto& bin = errors.reliability[i];
      count[i] += bin.count;
      probability[i] += bin.count * bin.mean_probability;
      right[i] += bin.count * bin.correct_share;
    }
  }
  double ece() const {
    double gap = 0, all = 0;
    for (std::size_t i = 0; i < 10; ++i) gap += std::abs(probability[i] - right[i]), all += count[i];
    return gap / all;
  }
};

TEST(SmallWorld, SoftBeatsNearestNeighbourAndMaximumLikelihood) {
  Pooled soft, nearest, likeliest;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const SmallWorld world = rowOfChairs(seed);
    soft.add(errorsOf<SoftAssociator>(world));
    nearest.add(errorsOf<NearestNeighborAssociator>(world));
    likeliest.add(errorsOf<MaximumLikelihoodAssociator>(world));
  }
  EXPECT_GT(soft.accuracy, nearest.accuracy);
  EXPECT_GT(soft.accuracy, likeliest.accuracy);
  EXPECT_GT(soft.accuracy, 0.95);
  EXPECT_LE(soft.ece(), 0.05);
}

TEST(SmallWorld, HindsightFindsEveryChairOnce) {
  Pooled batch;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const SmallWorld world = rowOfChairs(seed);
    SoftAssociator associator;
    LandmarkMap map;
    runOnline(world, associator, map);
    const auto result =
        reassociate(world.frames, map.landmarks(), map.identity(), *associator.model(), map.rules());
    const auto errors = evaluateAssociations(world.truth, writtenDown(world, result));
    batch.add(errors);
    EXPECT_GE(errors.accuracy, 0.97) << "seed " << seed;
    map.adopt(world.frames, result);
    EXPECT_EQ(map.confirmed().size(), 6u) << "seed " << seed;
  }
  EXPECT_GE(batch.accuracy, 0.98);
  EXPECT_LE(batch.ece(), 0.05);
}

TEST(Reassociation, PosteriorsSumToOneAndTheFirstSightingIsNew) {
  const SmallWorld world = rowOfChairs(3);
  const auto result = reassociate(world.frames, {}, {}, AssociationModel{}, LandmarkRules{});
  std::set<LandmarkId> known;
  ASSERT_EQ(result.decisions.size(), world.frames.size());
  for (std::size_t f = 0; f < world.frames.size(); ++f) {
    ASSERT_EQ(result.decisions[f].size(), world.frames[f].size());
    for (const auto& [association, landmark] : result.decisions[f]) {
      double sum = 0;
      for (const auto& [id, probability] : association.posterior) sum += probability;
      EXPECT_NEAR(sum, 1, 1e-9);
      EXPECT_EQ(association.landmark.valid(), known.contains(landmark));
    }
    for (const auto& decision : result.decisions[f]) known.insert(decision.landmark);
  }
  EXPECT_EQ(known.size(), result.landmarks.size()) << "every landmark has sightings";
}

TEST(Reassociation, SettlesAndIsTheSameAgain) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const SmallWorld world = rowOfChairs(seed);
    const auto first = reassociate(world.frames, {}, {}, AssociationModel{}, LandmarkRules{});
    const auto second = reassociate(world.frames, {}, {}, AssociationModel{}, LandmarkRules{});
    EXPECT_TRUE(first.settled) << "seed " << seed << " after " << first.rounds << " rounds";
    ASSERT_EQ(first.landmarks.size(), second.landmarks.size());
    for (std::size_t j = 0; j < first.landmarks.size(); ++j)
      EXPECT_EQ(first.landmarks[j].position, second.landmarks[j].position);
  }
}

// One chair or two, seen in turns, each by its own tracks.
SmallWorld inTurns(unsigned seed, const std::vector<Eigen::Vector2d>& chairs) {
  Random random(seed);
  SmallWorld world;
  for (int frame = 0; frame < 60; ++frame) {
    const int chair = (frame / 10) % static_cast<int>(chairs.size());
    const auto& place = chairs[static_cast<std::size_t>(chair)];
    addFrame(world);
    addSighting(world, chair, place.x() + 0.05 * normal(random), place.y() + 0.05 * normal(random), 0.07, 0.7,
                frame / 10);
  }
  return world;
}

TEST(Reassociation, PartsALandmarkOfTwoChairs) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const auto world = inTurns(seed, {{0, 0}, {0.7, 0}});
    const auto result =
        reassociate(world.frames, {landmarkAt(0, 0.35, 0, 0.3)}, {}, AssociationModel{}, LandmarkRules{});
    ASSERT_EQ(result.landmarks.size(), 2u) << "seed " << seed;
    const auto errors = evaluateAssociations(world.truth, writtenDown(world, result));
    EXPECT_EQ(errors.accuracy, 1) << "seed " << seed;
  }
}

TEST(Reassociation, JoinsTwoLandmarksOfOneChair) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const auto world = inTurns(seed, {{0, 0}});
    const auto result = reassociate(world.frames, {landmarkAt(3, -0.15, 0), landmarkAt(4, 0.15, 0)}, {},
                                    AssociationModel{}, LandmarkRules{});
    ASSERT_EQ(result.landmarks.size(), 1u) << "seed " << seed;
    EXPECT_LT(result.landmarks[0].position.head<2>().norm(), 0.04);
    EXPECT_EQ(result.landmarks[0].observations, 60);
  }
}

TEST(Reassociation, ALandmarkThatNobodyClaimsGoes) {
  const auto world = inTurns(1, {{0, 0}});
  const auto result = reassociate(world.frames, {landmarkAt(1, 0, 0), landmarkAt(2, 5, 5)}, {},
                                  AssociationModel{}, LandmarkRules{});
  ASSERT_EQ(result.landmarks.size(), 1u);
  EXPECT_EQ(result.landmarks[0].id, LandmarkId{1});
}

TEST(SmallWorld, ChairsSideBySideStayTwo) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Random random(seed);
    SmallWorld world;
    for (int frame = 0; frame < 60; ++frame) {
      addFrame(world);
      for (int chair = 0; chair < 2; ++chair)
        addSighting(world, chair, 0.5 * chair + 0.06 * normal(random), 0.06 * normal(random), 0.07, 0.7,
                    chair);
    }
    SoftAssociator associator;
    LandmarkMap map;
    const auto errors = evaluateAssociations(world.truth, runOnline(world, associator, map));
    EXPECT_EQ(map.landmarks().size(), 2u) << "seed " << seed;
    EXPECT_EQ(errors.accuracy, 1) << "seed " << seed;
    const auto result = reassociate(world.frames, {}, {}, *associator.model(), map.rules());
    EXPECT_EQ(result.landmarks.size(), 2u) << "seed " << seed;
  }
}

// Thirty frames at one place, then thirty at another while the first place is seen empty: hindsight replays
// the misses in the order of time, so that the chair's many sightings do not outweigh them.
TEST(Reassociation, AMovedChairIsWhereItWasSeenLast) {
  SoftAssociator associator;
  LandmarkMap map;
  std::vector<std::vector<WorldMeasurement>> frames;
  std::set<LandmarkId> before;
  for (int i = 0; i < 60; ++i) {
    WorldMeasurement seen = sightingAt(i < 30 ? 1 : 4, 2, 0, 0.05);
    seen.measurement.frame = FrameId{i};
    seen.measurement.t = 0.1 * i;
    seen.measurement.proposal.score = 0.6;
    frames.push_back({seen});
    const Association association = associator.associate(frames.back(), map.landmarks()).front();
    const LandmarkId id = map.update(seen, association);
    associator.assigned(seen, id);
    if (i < 30) before.insert(id);
    if (i >= 30)
      for (const auto old : before) map.miss(old);
  }
  ASSERT_EQ(before.size(), 1u);
  ASSERT_EQ(map.confirmed().size(), 1u) << "the misses outweigh the sightings while the run goes on, too";
  EXPECT_NEAR(map.confirmed().front().position.x(), 4, 0.02);
  const auto result = reassociate(frames, map.landmarks(), map.identity(), *associator.model(), map.rules());
  map.adopt(frames, result);
  ASSERT_EQ(map.confirmed().size(), 1u);
  EXPECT_NEAR(map.confirmed().front().position.x(), 4, 0.02);
  // Surest after its sightings, odds of 10^9; each of thirty misses takes (1 - .6) / (1 - .15) of them.
  const double odds = 1e9 * std::pow(0.4 / 0.85, 30);
  EXPECT_NEAR(map.find(*before.begin())->existence, odds / (1 + odds), 1e-3);
}

}  // namespace
}  // namespace roomgraph::test
