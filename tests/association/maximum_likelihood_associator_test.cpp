// SPDX-License-Identifier: BSD-3-Clause
// Maximum-likelihood associator against brute-force Bayes' rule, with gates and class.
#include "maximum_likelihood_associator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "random_poses.h"
#include "roomgraph/association/register_classes.h"
#include "roomgraph/core/class_registry.h"
#include "roomgraph/core/config.h"
#include "sightings.h"

namespace roomgraph::test {
namespace {

constexpr double kGate = 3, kReach = 0.75 * 0.6, kNewDensity = 0.05;

std::vector<Association> associate(const std::vector<WorldMeasurement>& seen,
                                   const std::vector<Landmark>& landmarks, const std::string& config = "") {
  MaximumLikelihoodAssociator associator;
  Config::fromText("[association]\n" + config).read("association", associator);
  return associator.associate(seen, landmarks);
}

// Bayes' rule over every landmark, written down without gates' shortcuts: density N(d; 0, S) per candidate.
std::map<LandmarkId, double> posteriorByBayes(const WorldMeasurement& seen,
                                        const std::vector<Landmark>& landmarks) {
  std::map<LandmarkId, double> posterior{{LandmarkId{}, kNewDensity}};
  double sum = kNewDensity;
  for (const auto& landmark : landmarks) {
    const double dx = seen.world_from_object.translation().x() - landmark.position.x(),
                 dy = seen.world_from_object.translation().y() - landmark.position.y();
    const double a = seen.covariance(0, 0) + landmark.covariance(0, 0),
                 b = seen.covariance(0, 1) + landmark.covariance(0, 1),
                 c = seen.covariance(1, 1) + landmark.covariance(1, 1), det = a * c - b * b;
    const double squared = (c * dx * dx - 2 * b * dx * dy + a * dy * dy) / det;
    const bool possible = landmark.class_name == seen.measurement.proposal.class_name &&
                          std::hypot(dx, dy) <= kReach && squared <= kGate * kGate;
    const double density = possible ? std::exp(-squared / 2) / (2 * M_PI * std::sqrt(det)) : 0;
    if (possible) posterior[landmark.id] = density;
    sum += density;
  }
  for (auto& [id, weight] : posterior) weight /= sum;
  return posterior;
}

TEST(MaximumLikelihoodAssociator, PosteriorIsBayesRuleOverGateAndNew) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    Random random(seed);
    std::vector<Landmark> landmarks;
    for (int i = 0; i < 8; ++i) {
      landmarks.push_back(landmarkAt(i, random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6),
                                     random.uniform(0.05, 0.2), random.index(4) ? "chair" : "door"));
      landmarks.back().covariance(0, 1) = landmarks.back().covariance(1, 0) = random.uniform(-0.002, 0.002);
    }
    std::vector<WorldMeasurement> seen;
    for (int k = 0; k < 4; ++k)
      seen.push_back(sightingAt(random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6)));
    const auto result = associate(seen, landmarks);
    ASSERT_EQ(result.size(), seen.size());
    std::set<LandmarkId> taken;
    for (std::size_t k = 0; k < seen.size(); ++k) {
      EXPECT_EQ(result[k].measurement, k);
      const auto expected = posteriorByBayes(seen[k], landmarks);
      EXPECT_EQ(result[k].posterior.size(), expected.size());
      double sum = 0;
      for (const auto& [id, probability] : result[k].posterior) {
        ASSERT_TRUE(expected.contains(id));
        EXPECT_NEAR(probability, expected.at(id), 1e-12);
        sum += probability;
      }
      EXPECT_NEAR(sum, 1, 1e-12);
      EXPECT_DOUBLE_EQ(result[k].probability, probabilityOf(result[k], result[k].landmark));
      if (result[k].landmark.valid()) {
        EXPECT_TRUE(taken.insert(result[k].landmark).second)
            << "one landmark for two measurements, seed " << seed;
      }
    }
  }
}

TEST(MaximumLikelihoodAssociator, NearestOfTwoMeasurementsGetsTheLandmark) {
  const auto result = associate({sightingAt(0.2, 0), sightingAt(0.02, 0)}, {landmarkAt(4, 0, 0)});
  EXPECT_FALSE(result[0].landmark.valid());
  EXPECT_EQ(result[1].landmark, LandmarkId{4});
}

TEST(MaximumLikelihoodAssociator, LoserTakesItsSecondChoice) {
  const auto result =
      associate({sightingAt(0.05, 0), sightingAt(0, 0)}, {landmarkAt(1, 0, 0), landmarkAt(2, 0.3, 0)});
  EXPECT_EQ(result[1].landmark, LandmarkId{1});
  EXPECT_EQ(result[0].landmark, LandmarkId{2});
}

TEST(MaximumLikelihoodAssociator, AnotherClassIsNoCandidate) {
  const auto result = associate({sightingAt(0, 0)}, {landmarkAt(1, 0, 0, 0.1, "sofa")});
  EXPECT_FALSE(result[0].landmark.valid());
  EXPECT_EQ(result[0].posterior.size(), 1u);
  EXPECT_DOUBLE_EQ(result[0].probability, 1);
}

TEST(MaximumLikelihoodAssociator, SigmaGateShutsOutWhatIsFarForItsCovariance) {
  // Joint sigma 0.1 sqrt(2) = 0.141 m; gate 3 sigma = 0.424 m.
  EXPECT_TRUE(associate({sightingAt(0.42, 0)}, {landmarkAt(1, 0, 0)})[0].posterior.size() == 2);
  EXPECT_TRUE(associate({sightingAt(0.43, 0)}, {landmarkAt(1, 0, 0)})[0].posterior.size() == 1);
  EXPECT_TRUE(associate({sightingAt(0.43, 0)}, {landmarkAt(1, 0, 0)}, "gate_sigma = 4")[0].posterior.size() ==
              2);
}

TEST(MaximumLikelihoodAssociator, ObjectsDoNotStandInEachOtherHoweverLooseTheCovariance) {
  // Width 0.6 m, ratio 0.75: 0.45 m.
  const std::vector<Landmark> vague{landmarkAt(1, 0, 0, 2)};
  EXPECT_EQ(associate({sightingAt(0.44, 0)}, vague)[0].posterior.size(), 2u);
  EXPECT_EQ(associate({sightingAt(0.46, 0)}, vague)[0].posterior.size(), 1u);
}

TEST(MaximumLikelihoodAssociator, NewLandmarkWhenNothingFitsWellEnough) {
  // Density at the centre of a joint sigma of 1.414 m: 1 / (2 pi 2) = 0.08 per m2.
  const std::vector<Landmark> vague{landmarkAt(1, 0, 0, 1)};
  const std::vector<WorldMeasurement> seen{sightingAt(0, 0, 0, 1)};
  EXPECT_TRUE(associate(seen, vague, "new_density_per_m2 = 0.07")[0].landmark.valid());
  const auto fresh = associate(seen, vague, "new_density_per_m2 = 0.09");
  EXPECT_FALSE(fresh[0].landmark.valid());
  EXPECT_NEAR(fresh[0].probability, 0.09 / (0.09 + 1 / (4 * M_PI)), 1e-12);
}

TEST(MaximumLikelihoodAssociator, NothingInNothingOut) {
  EXPECT_TRUE(associate({}, {landmarkAt(1, 0, 0)}).empty());
}

TEST(MaximumLikelihoodAssociator, IsMadeByName) {
  association::registerClasses();
  association::registerClasses();
  EXPECT_TRUE(createStage<Associator>("MaximumLikelihoodAssociator", "test"));
}

}  // namespace
}  // namespace roomgraph::test
