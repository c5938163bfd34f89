// SPDX-License-Identifier: BSD-3-Clause
// Alternatives of a measurement against gate and density of each landmark alone.
#include "roomgraph/association/measurement_model.h"

#include <gtest/gtest.h>

#include <random>

#include "sightings.h"

namespace roomgraph::test {
namespace {

TEST(MeasurementModel, AlternativesAreTheLandmarksInGateWithTheirDensities) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-4, 4), sigma_m(0.02, 0.5), turn(-3, 3), score(0, 1);
  int in_gate = 0, on_ray = 0;
  for (int i = 0; i < 200; ++i) {
    WorldMeasurement seen = sightingAt(place(random), place(random), turn(random), sigma_m(random));
    seen.measurement.proposal.score = score(random);
    seen.measurement.proposal.camera_from_object = poseFromYpr(place(random), place(random), 1, turn(random), 0, 0).inverse() * seen.world_from_object;
    seen.covariance(0, 0) *= 3, seen.covariance(0, 1) = seen.covariance(1, 0) = 0.5 * seen.covariance(1, 1);
    std::vector<Landmark> landmarks;
    for (int j = 0; j < 40; ++j) landmarks.push_back(landmarkAt(j, place(random), place(random), sigma_m(random)));
    MeasurementModel model;
    model.wrong_depth = i % 2 == 0 ? 0.5 : 0;
    WeightedLandmarks expected;
    for (const Landmark& landmark : landmarks) {
      if (!model.inGate(seen, landmark)) continue;
      expected.emplace_back(landmark.id, model.density(seen, landmark));
      on_ray += model.squaredDistance(seen, landmark) > model.gate_sigma * model.gate_sigma;
    }
    in_gate += static_cast<int>(expected.size());
    EXPECT_EQ(model.alternatives(seen, landmarks).same_class, expected) << i;
  }
  EXPECT_GT(in_gate - on_ray, 300);
  EXPECT_GT(on_ray, 100);
  EXPECT_LT(in_gate, 200 * 40 / 2);
}

// A television whose foot is estimated to be 5 cm in its cabinet stands on it all the same.
TEST(FootprintOverlap, IsNoneBetweenWhatStandsOnTopOfEachOther) {
  const ObjectShape cabinet{ShapeKind::kCuboid, 1.4, 0.45, 0.55}, television{ShapeKind::kCuboid, 1, 0.12, 0.6};
  const Pose3 below = poseFromYpr(1, 2, 0, 0.3, 0, 0);
  for (const auto& [z, expected] : {std::pair{0.6, 0.0}, {0.5, 0.0}, {0.3, 1.0}, {0.0, 1.0}}) {
    const Pose3 above = poseFromYpr(1, 2, z, 0.3, 0, 0);
    EXPECT_NEAR(footprintOverlap(television, above, cabinet, below), expected, 1e-9) << z;
    EXPECT_NEAR(footprintOverlap(cabinet, below, television, above), expected, 1e-9) << z;
  }
}

}  // namespace
}  // namespace roomgraph::test
