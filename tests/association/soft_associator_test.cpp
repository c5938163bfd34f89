// SPDX-License-Identifier: BSD-3-Clause
// SoftAssociator: recursion against the product of densities, exclusion, tracks, features, labels.
#include "soft_associator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "random_poses.h"
#include "roomgraph/association/register_classes.h"
#include "roomgraph/core/class_registry.h"
#include "roomgraph/core/config.h"
#include "sightings.h"

namespace roomgraph::test {
namespace {

SoftAssociator associatorWith(const std::string& config = "") {
  SoftAssociator associator;
  Config::fromText("[association]\n" + config).read("association", associator);
  return associator;
}

WorldMeasurement ofTrack(WorldMeasurement seen, std::int64_t track, double t) {
  seen.measurement.track = TrackId{track};
  seen.measurement.t = t;
  return seen;
}

TEST(SoftAssociator, PosteriorSumsToOneAndNoLandmarkServesTwo) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    Random random(seed);
    SoftAssociator associator = associatorWith();
    std::vector<Landmark> landmarks;
    for (int i = 0; i < 8; ++i)
      landmarks.push_back(landmarkAt(i, random.uniform(-1, 1), random.uniform(-1, 1), 0.1,
                                     random.index(4) ? "chair" : "sofa"));
    for (int frame = 0; frame < 5; ++frame) {
      std::vector<WorldMeasurement> seen;
      for (int k = 0; k < 5; ++k)
        seen.push_back(ofTrack(sightingAt(random.uniform(-1, 1), random.uniform(-1, 1)), k, 0.1 * frame));
      std::set<LandmarkId> taken;
      for (const auto& association : associator.associate(seen, landmarks)) {
        double sum = 0;
        for (const auto& [id, probability] : association.posterior) sum += probability;
        EXPECT_NEAR(sum, 1, 1e-9) << "seed " << seed;
        EXPECT_DOUBLE_EQ(association.probability, probabilityOf(association, association.landmark));
        if (!association.landmark.valid() ||
            landmarks[static_cast<std::size_t>(association.landmark.value)].class_name != "chair")
          continue;
        EXPECT_TRUE(taken.insert(association.landmark).second) << "seed " << seed;
      }
    }
  }
}

// Two landmarks, one measurement a frame, nothing forgotten: the recursion is the product of the frames'
// Student t densities, written out here by hand.
TEST(SoftAssociator, RecursionOverATrackIsTheProductOfItsFrames) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    Random random(seed);
    SoftAssociator associator = associatorWith(
        "forgetting = 0.0001\ntempering = 1\nwrong_depth = 0\ntail_degrees = 4\nshared_error_m = 0\n"
        "new_density_per_m2 = 0.05\ngate_sigma = 20");
    const std::vector<Landmark> landmarks{landmarkAt(1, 0, 0), landmarkAt(2, 0.4, 0)};
    double product[3] = {1, 1, 1};
    for (int frame = 0; frame < 4; ++frame) {
      const double x = random.uniform(0.1, 0.3), y = random.uniform(-0.2, 0.2);
      const double variance = 2 * 0.1 * 0.1;  // of measurement and landmark together
      for (int j = 0; j < 2; ++j) {
        const double dx = x - 0.4 * j, squared = (dx * dx + y * y) / variance;
        product[j] *= 2 / (2 * M_PI * variance) / std::pow(1 + squared / 2, 3);  // scale: half the variance
      }
      product[2] *= 0.05;
      const auto result = associator.associate({ofTrack(sightingAt(x, y), 7, 0.1 * frame)}, landmarks);
      const double sum = product[0] + product[1] + product[2];
      EXPECT_NEAR(probabilityOf(result[0], LandmarkId{1}), product[0] / sum, 2e-3) << "seed " << seed;
      EXPECT_NEAR(probabilityOf(result[0], LandmarkId{2}), product[1] / sum, 2e-3) << "seed " << seed;
    }
  }
}

TEST(SoftAssociator, AWrongStartIsOvercome) {
  SoftAssociator associator = associatorWith();
  const std::vector<Landmark> landmarks{landmarkAt(1, 0, 0), landmarkAt(2, 0.6, 0)};
  for (int frame = 0; frame < 5; ++frame)
    EXPECT_EQ(associator.associate({ofTrack(sightingAt(0.1, 0), 7, 0.1 * frame)}, landmarks)[0].landmark,
              LandmarkId{1});
  // Half way, the past decides; beyond it, the present does before long.
  EXPECT_EQ(associator.associate({ofTrack(sightingAt(0.32, 0), 7, 0.5)}, landmarks)[0].landmark,
            LandmarkId{1});
  int frames = 0;
  while (frames < 20 &&
         associator.associate({ofTrack(sightingAt(0.6, 0), 7, 0.6 + 0.1 * frames)}, landmarks)[0].landmark !=
             LandmarkId{2})
    ++frames;
  EXPECT_LE(frames, 3);
}

TEST(SoftAssociator, UnlikeFramesLinkATrackLess) {
  const std::vector<Landmark> landmarks{landmarkAt(1, 0, 0), landmarkAt(2, 0.6, 0)};
  double kept[2];
  for (const int alike : {0, 1}) {
    SoftAssociator associator = associatorWith();
    associator.associate({ofTrack(sightingAt(0.1, 0), 7, 0)}, landmarks);
    WorldMeasurement seen = ofTrack(sightingAt(0.3, 0), 7, 0.1);
    seen.measurement.beta = alike;
    kept[alike] = probabilityOf(associator.associate({seen}, landmarks)[0], LandmarkId{1});
  }
  EXPECT_NEAR(kept[0], 0.5, 0.05) << "half way, without a past";
  EXPECT_GT(kept[1], 0.8);
}

TEST(SoftAssociator, FeaturePointsRememberTheirLandmark) {
  const std::vector<Landmark> landmarks{landmarkAt(1, 0, 0), landmarkAt(2, 0.6, 0)};
  SoftAssociator associator = associatorWith();
  WorldMeasurement seen = sightingAt(0.6, 0);
  seen.measurement.features = {11, 12, 13, 14, 15, 16, 17, 18, 19, 20};
  associator.assigned(seen, LandmarkId{2});
  WorldMeasurement between = sightingAt(0.3, 0);
  EXPECT_NEAR(probabilityOf(associator.associate({between}, landmarks)[0], LandmarkId{2}), 0.5, 0.05)
      << "without points: neutral";
  between.measurement.features = {15, 16, 17, 18, 19, 20, 21, 22};
  EXPECT_GT(probabilityOf(associator.associate({between}, landmarks)[0], LandmarkId{2}), 0.6);
  LandmarkIdentity identity;
  identity.merge(LandmarkId{2}, LandmarkId{1});
  associator.identitiesChanged(identity);
  EXPECT_GT(probabilityOf(associator.associate({between}, landmarks)[0], LandmarkId{1}), 0.6);
}

TEST(SoftAssociator, AWrongLabelMakesNoLandmark) {
  std::vector<Landmark> landmarks{landmarkAt(1, 0, 0, 0.1, "sofa")};
  landmarks[0].shape = {ShapeKind::kCuboid, 1.8, 0.9, 0.8};
  landmarks[0].existence = 0.999;
  const WorldMeasurement seen = sightingAt(0.1, 0.3);
  EXPECT_EQ(associatorWith().associate({seen}, landmarks)[0].landmark, LandmarkId{1});
  landmarks[0].existence = 0.05;
  EXPECT_FALSE(associatorWith().associate({seen}, landmarks)[0].landmark.valid()) << "hardly there";
  landmarks[0].existence = 0.999;
  EXPECT_FALSE(associatorWith().associate({sightingAt(0, 1.2)}, landmarks)[0].landmark.valid())
      << "beside it";
}

TEST(SoftAssociator, TheSofaItselfDoesNotKeepItsOtherLabelOut) {
  std::vector<Landmark> landmarks{landmarkAt(1, 0, 0, 0.1, "sofa")};
  landmarks[0].shape = {ShapeKind::kCuboid, 1.8, 0.9, 0.8};
  landmarks[0].existence = 0.999;
  const auto result =
      associatorWith().associate({sightingAt(0, 0, 0, 0.1, "sofa"), sightingAt(0.1, 0.3)}, landmarks);
  EXPECT_EQ(result[0].landmark, LandmarkId{1});
  EXPECT_EQ(result[1].landmark, LandmarkId{1}) << "two boxes, one of them misnamed";
}

// Camera at the origin; the proposal lies behind the chair, on the same ray.
TEST(SoftAssociator, AFailedDepthIsToldByTheRay) {
  const auto associate = [](double bearing, double score) {
    WorldMeasurement seen = sightingAt(4 * std::cos(bearing), 4 * std::sin(bearing));
    seen.measurement.proposal.camera_from_object = seen.world_from_object;
    seen.measurement.proposal.score = score;
    return associatorWith().associate({seen}, {landmarkAt(1, 2, 0)})[0].landmark;
  };
  EXPECT_EQ(associate(0, 0.0), LandmarkId{1});
  EXPECT_FALSE(associate(0, 1.0).valid()) << "a good proposal has the right depth";
  EXPECT_FALSE(associate(0.5, 0.0).valid()) << "another direction";
}

TEST(SoftAssociator, ANewLandmarkTakesOverItsTrack) {
  SoftAssociator associator = associatorWith();
  const WorldMeasurement first = ofTrack(sightingAt(0, 0), 3, 0);
  EXPECT_FALSE(associator.associate({first}, {})[0].landmark.valid());
  associator.assigned(first, LandmarkId{5});
  const std::vector<Landmark> landmarks{landmarkAt(5, 0, 0), landmarkAt(6, 0.6, 0)};
  EXPECT_GT(
      probabilityOf(associator.associate({ofTrack(sightingAt(0.3, 0), 3, 0.1)}, landmarks)[0], LandmarkId{5}),
      0.8);
}

// The odds of "new" against a landmark, right after a door was first seen and later.
TEST(SoftAssociator, ANewDoorMakesNewObjectsMoreProbable) {
  SoftAssociator associator = associatorWith("door_gain = 3\ndoor_cue_s = 10");
  const std::vector<Landmark> chairs{landmarkAt(1, 0, 0)};
  std::int64_t track = 0;
  const auto odds_at = [&](double t) {
    const auto decision = associator.associate({ofTrack(sightingAt(0.1, 0), ++track, t)}, chairs).at(0);
    return probabilityOf(decision, LandmarkId{}) / probabilityOf(decision, LandmarkId{1});
  };
  WorldMeasurement door = ofTrack(sightingAt(3, 0), 99, 5);
  door.measurement.proposal.shape.kind = ShapeKind::kPlanar;
  const double without = odds_at(4);
  associator.assigned(door, LandmarkId{2});
  EXPECT_NEAR(odds_at(6) / without, 3, 1e-9);
  EXPECT_NEAR(odds_at(15.1) / without, 1, 1e-9) << "too long ago";
  door.measurement.t = 16;
  associator.assigned(door, LandmarkId{2});
  EXPECT_NEAR(odds_at(17) / without, 1, 1e-9) << "not new";
  associator.assigned(door, LandmarkId{3});
  EXPECT_NEAR(odds_at(17) / without, 3, 1e-9);
}

TEST(SoftAssociator, AllVariantsAreMadeByName) {
  association::registerClasses();
  for (const char* name : {"SoftAssociator", "NearestNeighborAssociator", "MaximumLikelihoodAssociator"})
    EXPECT_TRUE(createStage<Associator>(name, "test")) << name;
  EXPECT_TRUE(createStage<Associator>("SoftAssociator", "test")->model());
  EXPECT_FALSE(createStage<Associator>("NearestNeighborAssociator", "test")->model());
}

}  // namespace
}  // namespace roomgraph::test
