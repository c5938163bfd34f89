// SPDX-License-Identifier: BSD-3-Clause
// Probability of existence from weighted evidence, and what a config may say about the weights.
#include "roomgraph/estimation/existence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "roomgraph/core/errors.h"

namespace roomgraph::test {
namespace {

TEST(ExistenceModel, LogOddsAreTheWeightedSum) {
  ExistenceOptions options;
  options.cylinder = {"bias -1", "filled 2", "crossed -3.5"};
  options.cuboid = {"bias 0.25"};
  options.planar = {};
  const ExistenceModel model(options);
  ExistenceEvidence evidence;
  evidence.filled = 0.75;
  evidence.crossed = 0.2;
  evidence.turned = 0.9;  // has no weight
  EXPECT_NEAR(model.probability(ShapeKind::kCylinder, evidence), 1 / (1 + std::exp(1 - 1.5 + 0.7)), 1e-12);
  EXPECT_NEAR(model.probability(ShapeKind::kCuboid, evidence), 1 / (1 + std::exp(-0.25)), 1e-12);
  EXPECT_NEAR(model.probability(ShapeKind::kPlanar, evidence), 0.5, 1e-12);
}

// Every field has its own name: raising it alone, with a weight for its name alone, raises the probability.
TEST(ExistenceModel, EveryNameIsOfItsOwnField) {
  using Field = double ExistenceEvidence::*;
  using E = ExistenceEvidence;
  const std::vector<std::pair<std::string, Field>> fields = {{"filter", &E::filter},
                                                             {"sightings", &E::sightings},
                                                             {"directions", &E::directions},
                                                             {"score", &E::score},
                                                             {"label", &E::label},
                                                             {"scatter", &E::scatter},
                                                             {"turned", &E::turned},
                                                             {"size", &E::size},
                                                             {"measured", &E::measured},
                                                             {"detected", &E::detected},
                                                             {"contested", &E::contested},
                                                             {"outdone", &E::outdone},
                                                             {"mislabelled", &E::mislabelled},
                                                             {"crossed", &E::crossed},
                                                             {"filled", &E::filled},
                                                             {"spread", &E::spread},
                                                             {"beside_crossed", &E::beside_crossed},
                                                             {"beside_filled", &E::beside_filled},
                                                             {"beams_crossed", &E::beams_crossed},
                                                             {"above_filled", &E::above_filled},
                                                             {"uneven", &E::uneven},
                                                             {"confidence", &E::confidence},
                                                             {"missed_since", &E::missed_since},
                                                             {"emptied", &E::emptied},
                                                             {"shorter", &E::shorter}};
  ASSERT_EQ(fields.size(), E::kNames.size());
  for (const auto& [name, field] : fields) {
    ExistenceOptions options;
    options.cuboid = {name + " 1"};
    E evidence;
    evidence.*field = 1;
    EXPECT_NEAR(ExistenceModel(options).probability(ShapeKind::kCuboid, evidence), 1 / (1 + std::exp(-1)),
                1e-12)
        << name;
  }
}

TEST(ExistenceModel, SureFromProbabilityAndSightingsOn) {
  ExistenceOptions options;
  options.least_probability = 0.6;
  options.least_sightings = 4;
  Landmark landmark;
  for (const auto& [existence, observations] : {std::pair{0.6, 4}, {0.59, 9}, {0.9, 3}}) {
    landmark.existence = existence;
    landmark.observations = observations;
    EXPECT_EQ(options.isSure(landmark), existence == 0.6) << existence;
  }
  landmark.shape.kind = ShapeKind::kPlanar;
  landmark.existence = 0.7;
  landmark.observations = 1;
  EXPECT_TRUE(options.isSure(landmark)) << "what is in a wall, from the first on";
  options.least_planar_sightings = 2;
  EXPECT_FALSE(options.isSure(landmark));
}

TEST(ExistenceModel, WhatIsNoWeightIsNamed) {
  for (const std::string entry : {"filed 2", "filled", "filled two", "filled 2 3", ""}) {
    ExistenceOptions options;
    options.planar = {"bias 1", entry};
    try {
      ExistenceModel model(options);
      ADD_FAILURE() << "'" << entry << "' was taken";
    } catch (const ConfigError& error) {
      const std::string what = error.what();
      EXPECT_NE(what.find("[existence] planar_weights: '" + entry + "'"), std::string::npos) << what;
    }
  }
}

// A stray ray more or less must not turn a good landmark into none: the shipped weights agree with the
// meaning of the evidence.
TEST(ExistenceModel, ShippedWeightsHaveTheRightSigns) {
  const ExistenceModel model{ExistenceOptions{}};
  using E = ExistenceEvidence;
  for (const auto kind : {ShapeKind::kCylinder, ShapeKind::kCuboid, ShapeKind::kPlanar}) {
    const double neutral = model.probability(kind, {});
    for (const auto field :
         {&E::sightings, &E::directions, &E::score, &E::label, &E::detected, &E::filled, &E::spread}) {
      E evidence;
      evidence.*field = 1;
      EXPECT_GE(model.probability(kind, evidence), neutral) << toString(kind);
    }
    for (const auto field :
         {&E::scatter, &E::turned, &E::contested, &E::crossed, &E::beside_crossed, &E::beams_crossed}) {
      E evidence;
      evidence.*field = 1;
      EXPECT_LE(model.probability(kind, evidence), neutral) << toString(kind);
    }
  }
}

}  // namespace
}  // namespace roomgraph::test
