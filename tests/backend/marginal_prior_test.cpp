// SPDX-License-Identifier: BSD-3-Clause
// Marginal prior: sliding window against the batch solution, and against marginal covariances of landmarks.
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "errors_of.h"
#include "simulated_loop.h"
#include "sliding_window.h"

namespace roomgraph::test {
namespace {

// Everything lies on one line and is measured along it: no rotation helps, the problem is linear.
struct Rail {
  explicit Rail(unsigned seed, int poses) : random(seed) {
    for (int i = 0; i < poses; ++i) places.push_back(0.5 * i);
  }
  Factor movement(int i) {
    BetweenFactor f{NodeId{i}, NodeId{i + 1}};
    f.covariance *= 0.01;
    f.a_from_b.translation().x() = places[1] - places[0] + 0.1 * gauss(random);
    return f;
  }
  Factor sighting(int i, int k) {
    LandmarkFactor f{NodeId{i}, LandmarkId{k}};
    f.covariance *= 0.04;
    f.robust_width = 0;
    f.position_in_robot.x() = 3.0 * k - places[static_cast<std::size_t>(i)] + 0.2 * gauss(random);
    return f;
  }
  Random random;
  std::vector<double> places;
};

TEST(MarginalPrior, WindowOnALinearChainEqualsTheWholeProblem) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    constexpr int kPoses = 25, kWindow = 5;
    Rail rail(seed, kPoses);
    FactorGraph batch;
    SlidingWindow window(kWindow);
    for (int k = 0; k < 3; ++k) {
      const LandmarkEstimate start{{3.0 * k, 0, 0}, 0};
      batch.addLandmark(LandmarkId{k}, start);
      window.addLandmark(LandmarkId{k}, start);
    }
    for (int i = 0; i < kPoses; ++i) {
      const Pose3 start = poseFromYpr(0.45 * i, 0, 0, 0, 0, 0);
      std::vector<Factor> factors;
      if (i > 0) factors.push_back(rail.movement(i - 1));
      for (int k = 0; k < 3; ++k) factors.push_back(rail.sighting(i, k));
      batch.addPose(NodeId{i}, start, i == 0);
      for (const auto& f : factors) batch.add(f);
      window.step(NodeId{i}, start, factors);
    }
    ASSERT_TRUE(batch.optimize(SolveOptions{100, 1e-15}).usable);
    for (int i = kPoses - kWindow; i < kPoses; ++i)
      EXPECT_LT((window.graph().pose(NodeId{i}).translation() - batch.pose(NodeId{i}).translation()).norm(),
                1e-7)
          << "seed " << seed << " pose " << i;
    for (int k = 0; k < 3; ++k)
      EXPECT_LT(
          (window.graph().landmark(LandmarkId{k}).position - batch.landmark(LandmarkId{k}).position).norm(),
          1e-7)
          << "seed " << seed << " landmark " << k;
    const auto expected = batch.landmarkCovariances(), found = window.graph().landmarkCovariances();
    ASSERT_TRUE(expected && found);
    // Along the rail; across it the lever arms depend on where the chain was linearised.
    const double variance = expected->at(LandmarkId{1})(0, 0);
    EXPECT_NEAR(found->at(LandmarkId{1})(0, 0), variance, 1e-6 * variance);
  }
}

TEST(MarginalPrior, WindowOnALoopStaysCloseToTheWholeProblem) {
  double of_window = 0, of_nothing = 0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    SimulatedLoop loop(seed);
    FactorGraph batch;
    SlidingWindow with(6), without(6, false);
    Pose3 guess = loop.truth().front();
    for (int k = 0; k < 3; ++k) {
      const LandmarkEstimate start{guess * loop.sighting(0, k).position_in_robot, 0};
      batch.addLandmark(LandmarkId{k}, start);
      for (auto* window : {&with, &without}) window->addLandmark(LandmarkId{k}, start);
    }
    for (int i = 0; i < loop.size(); ++i) {
      std::vector<Factor> factors;
      if (i > 0) {
        const BetweenFactor movement = loop.movement(i - 1, i);
        guess = with.graph().pose(NodeId{i - 1}) * movement.a_from_b;
        factors.push_back(movement);
      }
      for (int k = 0; k < 3; ++k) factors.push_back(loop.sighting(i, k));
      batch.addPose(NodeId{i}, guess, i == 0);
      for (const auto& f : factors) batch.add(f);
      for (auto* window : {&with, &without}) window->step(NodeId{i}, guess, factors);
    }
    ASSERT_TRUE(batch.optimize(100).usable);
    const NodeId last{loop.size() - 1};
    of_window += (with.graph().pose(last).translation() - batch.pose(last).translation()).norm() / 10;
    of_nothing += (without.graph().pose(last).translation() - batch.pose(last).translation()).norm() / 10;
  }
  EXPECT_LT(of_window, 2e-3);  // m; the estimate's own deviation is about 0.02 m
  EXPECT_LT(of_window, 0.3 * of_nothing);
}

// Every factor of the landmark touches a pose that is removed, so that the prior says all that is known of
// it.
TEST(MarginalPrior, OfAllMeasurementsIsTheInverseOfTheMarginalCovariance) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    SimulatedLoop loop(seed);
    FactorGraph graph = loop.graph();
    ASSERT_TRUE(graph.optimize(SolveOptions{100, 1e-14}).usable);
    const auto prior = graph.marginalize({{}, {LandmarkId{1}}, {}});
    const auto covariances = graph.landmarkCovariances();
    ASSERT_TRUE(prior && covariances);
    EXPECT_TRUE(prior->root.rightCols(3).isZero(0)) << "nothing was said about the size";
    const Eigen::MatrixXd root = prior->root.leftCols(4), inverse = (root.transpose() * root).inverse();
    const Eigen::Matrix4d& expected = covariances->at(LandmarkId{1});
    EXPECT_LT((inverse - expected).norm(), 1e-6 * expected.norm()) << "seed " << seed;
    EXPECT_LT(prior->offset.norm(), 1e-2) << "at the optimum nothing pulls";
  }
}

// The sighting of landmark 1 from pose 12 is among the kept variables: without it the prior says less.
TEST(MarginalPrior, FactorsAmongTheKeptStayWithTheCaller) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    SimulatedLoop loop(seed);
    FactorGraph graph = loop.graph();
    ASSERT_TRUE(graph.optimize(SolveOptions{100, 1e-14}).usable);
    const auto prior = graph.marginalize({{NodeId{12}}, {LandmarkId{1}}, {}});
    const auto all = graph.landmarkCovariances();
    ASSERT_TRUE(prior && all);
    FactorGraph rebuilt;
    rebuilt.addPose(NodeId{12}, graph.pose(NodeId{12}));
    rebuilt.addLandmark(LandmarkId{1}, graph.landmark(LandmarkId{1}));
    rebuilt.add(*prior);
    const auto looser = rebuilt.landmarkCovariances();
    ASSERT_TRUE(looser);
    const Eigen::Matrix4d more = looser->at(LandmarkId{1}) - all->at(LandmarkId{1});
    const Eigen::Vector4d difference = Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(more).eigenvalues();
    EXPECT_GT(difference.minCoeff(), -1e-9);
    EXPECT_GT(difference.maxCoeff(), 1e-6);
  }
}

TEST(MarginalPrior, DirectionsThatNothingMeasuresAreLeftOut) {
  // A point seen once without depth, and a landmark without yaw, leave with the pose that saw them.
  SimulatedLoop loop(1, 4);
  FactorGraph graph;
  for (int i = 0; i < 3; ++i) graph.addPose(NodeId{i}, loop.truth()[static_cast<std::size_t>(i)], i == 0);
  for (int i = 0; i < 2; ++i) graph.add(loop.movement(i, i + 1));
  graph.addLandmark(LandmarkId{0}, loop.objects()[0]);
  graph.add(loop.sighting(1, 0, false));
  graph.addPoint(PointId{0}, loop.truth()[1] * Eigen::Vector3d(0.1, 0.1, 3));
  CameraPointFactor seen{NodeId{1}, PointId{0}, {.width = 640, .height = 480, .fx = 500, .fy = 500}};
  graph.add(seen);
  const auto prior = graph.marginalize({{NodeId{2}}, {}, {}});
  ASSERT_TRUE(prior);
  EXPECT_TRUE(prior->root.allFinite());
  // They say nothing about pose 2, which the chain of two movements fixes alone.
  FactorGraph chain;
  for (int i = 0; i < 3; ++i) chain.addPose(NodeId{i}, graph.pose(NodeId{i}), i == 0);
  SimulatedLoop again(1, 4);
  for (int i = 0; i < 2; ++i) chain.add(again.movement(i, i + 1));
  const auto expected = chain.marginalize({{NodeId{2}}, {}, {}});
  ASSERT_TRUE(expected);
  const Eigen::MatrixXd information = prior->root.transpose() * prior->root,
                        of_chain = expected->root.transpose() * expected->root;
  EXPECT_LT((information - of_chain).norm(), 1e-6 * of_chain.norm());
}

TEST(MarginalPrior, NothingIsLeftOfWhatIsNotConnected) {
  SimulatedLoop loop(1, 4);
  FactorGraph graph;
  for (int i = 0; i < 3; ++i) graph.addPose(NodeId{i}, loop.truth()[static_cast<std::size_t>(i)]);
  graph.add(loop.movement(0, 1));
  EXPECT_FALSE(graph.marginalize({{NodeId{2}}, {}, {}}));
  EXPECT_FALSE(graph.marginalize({{NodeId{0}, NodeId{1}, NodeId{2}}, {}, {}}));
  EXPECT_THROW(graph.marginalize({{NodeId{7}}, {}, {}}), std::out_of_range);
}

TEST(MarginalPrior, PartsThatDoNotFitAreAnError) {
  FactorGraph graph;
  graph.addPose(NodeId{0}, Pose3::Identity());
  MarginalPrior prior;
  prior.variables.nodes = {NodeId{0}};
  prior.poses = {Pose3::Identity()};
  prior.root = Eigen::MatrixXd::Zero(2, 5);
  prior.offset = Eigen::VectorXd::Zero(2);
  EXPECT_NE(messageOf<std::invalid_argument>([&] { graph.add(prior); }).find("differ in size"),
            std::string::npos);
}

}  // namespace
}  // namespace roomgraph::test
