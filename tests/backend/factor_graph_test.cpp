// SPDX-License-Identifier: BSD-3-Clause
// FactorGraph on simulated loops: chi-squared, NEES, robustness, determinism and misuse.
#include "roomgraph/backend/factor_graph.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>

#include "errors_of.h"
#include "simulated_loop.h"

namespace roomgraph::test {
namespace {

// Movements 24 x 6, sightings 3 x 12 x 4; unknown are 23 poses and 3 objects.
constexpr double kFreedoms = 24 * 6 + 3 * 12 * 4 - 23 * 6 - 3 * 4;
constexpr unsigned kSeeds = 20;

TEST(FactorGraph, ResidualsOfANoisyLoopAreAsLargeAsTheNoise) {
  double sum = 0;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    SimulatedLoop loop(seed);
    FactorGraph graph = loop.graph();
    EXPECT_EQ(graph.poses(), 24u);
    EXPECT_EQ(graph.landmarks(), 3u);
    EXPECT_EQ(graph.factors(), 24u + 36u);
    const SolveReport report = graph.optimize();
    ASSERT_TRUE(report.usable) << report.message;
    EXPECT_LT(report.final_cost, report.initial_cost);
    sum += 2 * report.final_cost;
    EXPECT_LT(loop.meanPoseError(graph), 0.12) << "seed " << seed;
  }
  // Sum of squares ~ chi2 with seeds * freedoms; mean of 1 per freedom, standard deviation sqrt(2 / n).
  const double per_freedom = sum / (kSeeds * kFreedoms), sigma = std::sqrt(2 / (kSeeds * kFreedoms));
  EXPECT_NEAR(per_freedom, 1, 4 * sigma);
}

TEST(FactorGraph, LandmarkErrorsAgreeWithTheirCovariances) {
  double nees = 0;
  for (unsigned seed = 1; seed <= 2 * kSeeds; ++seed) {
    SimulatedLoop loop(seed);
    FactorGraph graph = loop.graph();
    ASSERT_TRUE(graph.optimize().usable);
    const auto covariances = graph.landmarkCovariances();
    ASSERT_TRUE(covariances);
    const LandmarkEstimate estimate = graph.landmark(LandmarkId{0});
    Eigen::Vector4d error;
    error << estimate.position - loop.objects()[0].position, wrapAngle(estimate.yaw - loop.objects()[0].yaw);
    nees += error.dot(covariances->at(LandmarkId{0}).inverse() * error);
  }
  // Mean of the normalised squared error is the dimension, 4; standard deviation of the mean sqrt(8 / runs) =
  // 0.45.
  EXPECT_NEAR(nees / (2 * kSeeds), 4, 3.3 * std::sqrt(8.0 / (2 * kSeeds)));
}

FactorGraph withGrossClosure(SimulatedLoop& loop, double robust_width) {
  FactorGraph graph = loop.graph();
  BetweenFactor wrong = loop.movement(0, 12);
  wrong.a_from_b = poseFromYpr(0, 0, 0, 0, 0, 0);  // "the far side of the loop is where it started": 4 m off
  wrong.robust_width = robust_width;
  graph.add(wrong);
  EXPECT_TRUE(graph.optimize().usable);
  return graph;
}

TEST(FactorGraph, RobustLossShrugsOffAGrossClosure) {
  SimulatedLoop loop(5), same(5), again(5);
  FactorGraph clean = loop.graph();
  ASSERT_TRUE(clean.optimize().usable);
  EXPECT_LT(same.meanPoseError(withGrossClosure(same, 1)), loop.meanPoseError(clean) + 0.02);
  EXPECT_GT(again.meanPoseError(withGrossClosure(again, 0)), 0.3)
      << "the outlier is harmless: the test proves nothing";
}

TEST(FactorGraph, RepeatedRunsGiveTheSameBits) {
  SimulatedLoop first(9), second(9);
  FactorGraph a = first.graph(), b = second.graph();
  a.optimize();
  b.optimize();
  for (int i = 0; i < first.size(); ++i)
    EXPECT_TRUE(a.pose(NodeId{i}).matrix() == b.pose(NodeId{i}).matrix()) << i;
}

TEST(FactorGraph, FixedPoseStays) {
  SimulatedLoop loop(2);
  FactorGraph graph = loop.graph();
  graph.optimize();
  EXPECT_TRUE(graph.pose(NodeId{0}).isApprox(loop.truth().front(), 1e-12));
}

TEST(FactorGraph, PlanarAndGroundFactorsLevelAPose) {
  FactorGraph graph;
  graph.addPose(NodeId{0}, poseFromYpr(1, 2, 0.3, 0.5, 0.2, -0.1));
  graph.addPose(NodeId{1}, poseFromYpr(3, 2, 0.3, 0.5, 0.2, -0.1));
  graph.add(PlanarFactor{NodeId{0}});
  GroundFactor ground{.node = NodeId{1}, .offset_m = 1.2};
  ground.normal_in_robot = poseFromYpr(0, 0, 0, 0, 0.3, 0).linear().transpose() * Eigen::Vector3d::UnitZ();
  graph.add(ground);
  // Yaw and place are free: hold them with a weak movement.
  BetweenFactor weak{NodeId{0}, NodeId{1}, poseFromYpr(2, 0, 1.2, 0, 0.3, 0), Matrix6d::Identity() * 1e4};
  graph.add(weak);
  ASSERT_TRUE(graph.optimize(200).usable);
  const Pose3 planar = graph.pose(NodeId{0}), seen = graph.pose(NodeId{1});
  EXPECT_NEAR(planar.translation().z(), 0, 1e-4);
  EXPECT_LT((planar.linear().col(2) - Eigen::Vector3d::UnitZ()).norm(), 1e-3);
  EXPECT_NEAR(seen.translation().z(), 1.2, 1e-3);
  EXPECT_LT((seen.linear() * ground.normal_in_robot - Eigen::Vector3d::UnitZ()).norm(), 1e-3);
}

TEST(FactorGraph, YawThatNobodyMeasuredStays) {
  SimulatedLoop loop(3, 4);
  FactorGraph graph;
  for (int i = 0; i < 4; ++i) graph.addPose(NodeId{i}, loop.truth()[static_cast<std::size_t>(i)], i == 0);
  for (int i = 0; i < 3; ++i) graph.add(loop.movement(i, i + 1));
  graph.addLandmark(LandmarkId{0}, {{0, 0, 0.2}, 0.7});
  for (int i = 0; i < 4; ++i) graph.add(loop.sighting(i, 0, false));
  graph.add(LandmarkGroundFactor{LandmarkId{0}, 0.001});
  ASSERT_TRUE(graph.optimize().usable);
  EXPECT_DOUBLE_EQ(graph.landmark(LandmarkId{0}).yaw, 0.7);
  EXPECT_LT((graph.landmark(LandmarkId{0}).position - loop.objects()[0].position).norm(), 0.1);
  EXPECT_NEAR(graph.landmark(LandmarkId{0}).position.z(), 0, 0.002);
  const auto covariances = graph.landmarkCovariances();
  ASSERT_TRUE(covariances);
  EXPECT_NEAR(covariances->at(LandmarkId{0})(3, 3), M_PI * M_PI / 3, 1e-12);
}

TEST(FactorGraph, UnknownIdsAreErrorsThatNameThem) {
  FactorGraph graph;
  graph.addPose(NodeId{0}, Pose3::Identity(), true);
  graph.addLandmark(LandmarkId{1}, {});
  const auto error = [&](const auto& factor) {
    return messageOf<std::out_of_range>([&] { graph.add(factor); });
  };
  EXPECT_THAT(error(BetweenFactor{NodeId{0}, NodeId{77}}), ::testing::HasSubstr("77"));
  EXPECT_THAT(error(PlanarFactor{NodeId{78}}), ::testing::HasSubstr("78"));
  EXPECT_THAT(error(GroundFactor{NodeId{79}}), ::testing::HasSubstr("79"));
  EXPECT_THAT(error(LandmarkFactor{NodeId{0}, LandmarkId{80}}), ::testing::HasSubstr("80"));
  EXPECT_THAT(error(LandmarkFactor{NodeId{81}, LandmarkId{1}}), ::testing::HasSubstr("81"));
  EXPECT_THAT(error(LandmarkGroundFactor{LandmarkId{82}}), ::testing::HasSubstr("82"));
  EXPECT_THAT(error(LandmarkSizeFactor{LandmarkId{83}}), ::testing::HasSubstr("83"));
  EXPECT_THAT(error(LandmarkBoxFactor{NodeId{0}, LandmarkId{84}}), ::testing::HasSubstr("84"));
  EXPECT_THAT(error(CameraPointFactor{NodeId{0}, PointId{85}}), ::testing::HasSubstr("85"));
  EXPECT_THAT(error(PointLandmarkFactor{PointId{86}, LandmarkId{1}}), ::testing::HasSubstr("86"));
  EXPECT_THAT(error(LandmarkSideFactor{NodeId{0}, LandmarkId{87}}), ::testing::HasSubstr("87"));
  EXPECT_THROW(graph.add(BetweenFactor{NodeId{0}, NodeId{0}}), std::invalid_argument);
  EXPECT_THROW(graph.point(PointId{5}), std::out_of_range);
  EXPECT_THROW(graph.pose(NodeId{5}), std::out_of_range);
  EXPECT_THROW(graph.landmark(LandmarkId{5}), std::out_of_range);
  EXPECT_EQ(graph.factors(), 0u);
}

TEST(FactorGraph, StartsFromWhatAFormerGraphFoundForTheNamedVariables) {
  SimulatedLoop first(3), second(3);  // the same noise
  FactorGraph former = first.graph(), graph = second.graph();
  former.addPoint(PointId{4}, {1, 2, 3});
  graph.addPoint(PointId{4}, {0, 0, 0});
  graph.addPoint(PointId{5}, {5, 5, 5});
  ASSERT_TRUE(former.optimize().usable);
  const Pose3 one = graph.pose(NodeId{1});
  const Eigen::Vector3d zero = graph.landmark(LandmarkId{0}).position;
  graph.startFrom(former, {{NodeId{2}, NodeId{999}}, {LandmarkId{1}}, {PointId{4}, PointId{5}}});
  EXPECT_TRUE(graph.pose(NodeId{2}).matrix() == former.pose(NodeId{2}).matrix());
  EXPECT_TRUE(graph.pose(NodeId{1}).matrix() == one.matrix()) << "was not named";
  EXPECT_EQ(graph.landmark(LandmarkId{1}).position, former.landmark(LandmarkId{1}).position);
  EXPECT_EQ(graph.landmark(LandmarkId{1}).yaw, former.landmark(LandmarkId{1}).yaw);
  EXPECT_EQ(graph.landmark(LandmarkId{0}).position, zero);
  EXPECT_EQ(graph.point(PointId{4}), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(graph.point(PointId{5}), Eigen::Vector3d(5, 5, 5)) << "the former graph has none";
}

TEST(FactorGraph, TheValuesOfASolvedGraphStandForItsSolution) {
  SimulatedLoop first(3), second(3);  // the same noise
  FactorGraph solved = first.graph(), other = second.graph();
  const auto start = other.values();
  ASSERT_TRUE(solved.optimize().usable);
  EXPECT_NE(solved.values(), start);
  EXPECT_GT(other.chiSquared(), 2 * solved.chiSquared());
  other.setValues(solved.values());
  EXPECT_EQ(other.chiSquared(), solved.chiSquared());
  for (int i = 0; i < first.size(); ++i)
    EXPECT_TRUE(other.pose(NodeId{i}).matrix() == solved.pose(NodeId{i}).matrix()) << "pose " << i;
  for (int k = 0; k < 3; ++k)
    EXPECT_EQ(other.landmark(LandmarkId{k}).yaw, solved.landmark(LandmarkId{k}).yaw);
  EXPECT_TRUE(other.landmarkCovariances()->at(LandmarkId{1}) ==
              solved.landmarkCovariances()->at(LandmarkId{1}));
  other.setValues(start);
  EXPECT_EQ(other.values(), start);
  other.addPoint(PointId{0}, {1, 2, 3});
  EXPECT_EQ(other.values().size(), start.size() + 3);
  EXPECT_THROW(other.setValues(start), std::invalid_argument);
}

// CHOLMOD's own threads stay for good once it has begun some.
TEST(FactorGraph, AnOptimisationHasOneThread) {
  const auto threads = [] {
    namespace fs = std::filesystem;
    return std::distance(fs::directory_iterator("/proc/self/task"), fs::directory_iterator());
  };
  SimulatedLoop loop(1, 120);
  FactorGraph graph = loop.graph();
  for (int a = 0; a < loop.size(); ++a)
    for (int b = a + 2; b < loop.size(); b += 3) graph.add(loop.movement(a, b));  // fills the matrix
  const auto before = threads();
  std::ptrdiff_t during = 0;
  EXPECT_TRUE(graph.optimize({.max_iterations = 3, .progress = [&](int, double) { during = threads(); }}).usable);
  EXPECT_EQ(during, before);
  EXPECT_EQ(threads(), before);
}

TEST(FactorGraph, AddingTwiceIsAnError) {
  FactorGraph graph;
  graph.addPose(NodeId{0}, Pose3::Identity(), true);
  graph.addLandmark(LandmarkId{0}, {});
  EXPECT_THROW(graph.addPose(NodeId{0}, Pose3::Identity()), std::invalid_argument);
  EXPECT_THROW(graph.addLandmark(LandmarkId{0}, {}), std::invalid_argument);
  graph.addPoint(PointId{0}, Eigen::Vector3d::Zero());
  EXPECT_THROW(graph.addPoint(PointId{0}, Eigen::Vector3d::Zero()), std::invalid_argument);
}

}  // namespace
}  // namespace roomgraph::test
