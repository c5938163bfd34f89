// SPDX-License-Identifier: BSD-3-Clause
// Sizes with the usual one taken out of each: the mean is that of the measurements alone.
#include "size_mean.h"

#include <gtest/gtest.h>

#include <cmath>

#include "roomgraph/backend/factor_graph.h"
#include "shipped_objects.h"

namespace roomgraph::test {
namespace {

const ObjectModel& sofa() {
  return *shippedObjects().find("sofa");
}

// As a fit makes it of a measurement of the width, with variance: weighed against the usual size. The rest is
// not seen.
Proposal fitted(double measured_m, double sigma_m) {
  const double prior = 1 / (sofa().width_sigma_m * sofa().width_sigma_m),
               information = 1 / (sigma_m * sigma_m);
  Proposal out;
  out.shape = sofa().nominal();
  out.shape.width = (information * measured_m + prior * sofa().width_m) / (information + prior);
  out.size_information = {information, 0, 0};
  return out;
}

TEST(SizeMean, GivesBackTheMeasurement) {
  SizeMean mean;
  EXPECT_TRUE(mean.empty());
  for (int i = 0; i < 50; ++i) mean.add(fitted(2.4, 0.3), sofa(), 1);
  const LandmarkSizeFactor factor = mean.factor(LandmarkId{7});
  EXPECT_EQ(factor.landmark, LandmarkId{7});
  EXPECT_NEAR(factor.size_m.x(), 2.4, 1e-6);
  EXPECT_NEAR(factor.sigma_m.x(), 0.3, 1e-6) << "not surer than one of them";
  EXPECT_GT(factor.sigma_m.y(), 100) << "the depth was never seen";
}

// Weighted least squares by hand.
TEST(SizeMean, WeighsByInformationAndWeight) {
  SizeMean mean;
  mean.add(fitted(2.0, 0.1), sofa(), 0.8);
  mean.add(fitted(2.3, 0.2), sofa(), 0.4);
  const double a = 0.8 / (0.1 * 0.1), b = 0.4 / (0.2 * 0.2);
  const LandmarkSizeFactor factor = mean.factor(LandmarkId{7});
  EXPECT_NEAR(factor.size_m.x(), (a * 2.0 + b * 2.3) / (a + b), 1e-6);
  EXPECT_NEAR(factor.sigma_m.x(), std::sqrt(1 / ((a + b) / 1.2 * 0.8)), 1e-6)
      << "mean information, largest weight";
}

// Two parts go on beyond the image, a third sighting sees both ends.
TEST(SizeMean, PartsTellTheLeastSize) {
  SizeMean mean;
  mean.add(fitted(2.2, 0.1), sofa(), 1);
  EXPECT_FALSE(mean.leastSize(LandmarkId{7}));
  for (const auto& [length, weight] : {std::pair(2.0, 1.0), std::pair(2.3, 0.5)}) {
    Proposal part = fitted(length, 0.2);
    std::swap(part.size_information, part.least_size_information);
    mean.add(part, sofa(), weight);
  }
  const auto least = mean.leastSize(LandmarkId{7});
  ASSERT_TRUE(least);
  EXPECT_TRUE(least->at_least);
  EXPECT_NEAR(least->size_m.x(), 2.1, 1e-4);
  EXPECT_GT(least->sigma_m.y(), 100) << "of the depth nothing is known";
  EXPECT_NEAR(mean.factor(LandmarkId{7}).size_m.x(), 2.2, 1e-4) << "they measure nothing";
}

// Of sightings placed for the usual length some hold the sofa's left end, some both ends; it is 2.4 m long.
TEST(OffsetMean, PlacesTheMiddleByTheSizeThatIsTrue) {
  OffsetMean mean;
  PlaceBySize left = PlaceBySize::Zero();
  left(1, 0) = -0.5;
  mean.add(left, 4);
  LandmarkViewFactor factor;
  const ObjectShape usual = sofa().nominal();
  mean.apply(usual, factor);
  const Eigen::Vector3d truth(2.4, usual.depth, usual.height);
  const Eigen::Vector2d offset = factor.offset_m + factor.offset_by_size * truth;
  EXPECT_NEAR(offset.x(), 0, 1e-12);
  EXPECT_NEAR(offset.y(), (2.4 - usual.width) / 2, 1e-12) << "the middle they tell of is nearer to the left end";
  mean.add(PlaceBySize::Zero(), 4);  // half of the weight sees both ends
  mean.apply(usual, factor);
  EXPECT_NEAR((factor.offset_m + factor.offset_by_size * truth).y(), (2.4 - usual.width) / 4, 1e-12);
}

TEST(SizeMean, ThePriorIsTheUsualSize) {
  const LandmarkSizeFactor prior = sizePrior(LandmarkId{3}, sofa());
  EXPECT_TRUE(prior.size_m.isApprox(Eigen::Vector3d(sofa().width_m, sofa().depth_m, sofa().height_m)));
  EXPECT_TRUE(prior.sigma_m.isApprox(
      Eigen::Vector3d(sofa().width_sigma_m, sofa().depth_sigma_m, sofa().height_sigma_m)));
}

// The optimum where three directions measure this depth of a door, to 2 cm.
double optimalDepth(double measured_m, bool bounded) {
  const ObjectModel& door = *shippedObjects().find("door");
  const LandmarkId id{7};
  FactorGraph graph;
  graph.addPose(NodeId{0}, Pose3::Identity(), true);
  graph.addLandmark(id, {Eigen::Vector3d(2, 0, 0), 0, door.nominal()});
  LandmarkFactor seen{NodeId{0}, id};
  seen.position_in_robot = {2, 0, 0};
  graph.add(seen);
  for (int i = 0; i < 3; ++i) graph.add(LandmarkSizeFactor{id, {0.9, measured_m, 2.05}, {0.1, 0.02, 0.1}});
  if (bounded) graph.add(leastOfClass(id, door));
  graph.add(sizePrior(id, door));
  EXPECT_TRUE(graph.optimize().usable);
  return graph.landmark(id).shape.depth;
}

TEST(SizePrior, SidesWhosePlacesCrossLeaveSomethingBetweenThem) {
  EXPECT_LT(optimalDepth(-0.18, false), -0.1);
  EXPECT_GT(optimalDepth(-0.18, true), 0.02);
  EXPECT_LT(optimalDepth(-0.18, true), 0.04);
  EXPECT_EQ(optimalDepth(0.1, true), optimalDepth(0.1, false)) << "what is larger is as it was measured";
}

}  // namespace
}  // namespace roomgraph::test
