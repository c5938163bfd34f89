// SPDX-License-Identifier: BSD-3-Clause
// Marginal covariances of landmarks, and of poses by their marginal priors, against the dense inverse and by
// NEES.
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "residual_specimens.h"
#include "simulated_loop.h"

namespace roomgraph::test {
namespace {

// State of the small problem: poses 1 and 2 (pose 0 is held) and one object.
struct State {
  Pose3 first, second;
  std::vector<double> object;
};

// Poses move as t + dt, exp(w) R: the tangent in which covariances are given.
State moved(const State& state, const Eigen::VectorXd& delta) {
  const auto move = [](const Pose3& pose, const Vector6d& d) {
    Pose3 out = pose;
    out.translation() += d.head<3>();
    out.linear() = expSO3(d.tail<3>()) * pose.linear();
    return out;
  };
  State out{move(state.first, delta.head<6>()), move(state.second, delta.segment<6>(6)), state.object};
  for (int i = 0; i < 4; ++i) out.object[static_cast<std::size_t>(i)] += delta[12 + i];
  return out;
}

struct SmallProblem {
  Pose3 origin;
  std::vector<BetweenFactor> movements;
  std::vector<LandmarkFactor> sightings;

  Eigen::VectorXd residuals(const State& state) const {
    const Pose3* poses[] = {&origin, &state.first, &state.second};
    std::vector<double> all;
    const auto evaluate = [&](ceres::CostFunction& cost, const std::vector<Block>& blocks) {
      std::vector<const double*> pointers;
      for (const auto& block : blocks) pointers.push_back(block.value.data());
      std::vector<double> out(static_cast<std::size_t>(cost.num_residuals()));
      cost.Evaluate(pointers.data(), out.data(), nullptr);
      all.insert(all.end(), out.begin(), out.end());
    };
    for (const auto& f : movements) {
      std::vector<Block> blocks = blocksOf(*poses[f.a.value]);
      append(blocks, *poses[f.b.value]);
      evaluate(*sharedCost(f), blocks);
    }
    for (const auto& f : sightings) {
      std::vector<Block> blocks = blocksOf(*poses[f.node.value]);
      blocks.push_back({state.object});
      evaluate(*sharedCost(f), blocks);
    }
    return Eigen::Map<Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
  }
};

// (JᵀJ)⁻¹ over everything free, with a Jacobian by central differences.
Eigen::MatrixXd denseCovariance(const SmallProblem& problem, const State& state) {
  constexpr double kStep = 1e-6;
  Eigen::MatrixXd jacobian(problem.residuals(state).size(), 16);
  for (int j = 0; j < 16; ++j) {
    const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(16, j);
    jacobian.col(j) =
        (problem.residuals(moved(state, step)) - problem.residuals(moved(state, -step))) / (2 * kStep);
  }
  return (jacobian.transpose() * jacobian).inverse();
}

// Of one pose, from everything that the graph says about it: the prior's tangent is the one above.
std::optional<Matrix6d> poseCovariance(const FactorGraph& graph, int node) {
  const auto prior = graph.marginalize({{NodeId{node}}, {}, {}});
  if (!prior) return std::nullopt;
  return Matrix6d((prior->root.transpose() * prior->root).inverse());
}

void expectClose(const Eigen::MatrixXd& found, const Eigen::MatrixXd& expected, unsigned seed) {
  EXPECT_LT((found - expected).norm(), 1e-5 * expected.norm()) << "seed " << seed << "\n"
                                                               << found << "\n\n"
                                                               << expected;
}

TEST(MarginalCovariance, IsTheBlockOfTheDenseInverse) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    SimulatedLoop loop(seed, 8);
    SmallProblem problem{loop.truth()[0], {loop.movement(0, 1), loop.movement(1, 2)}, {}};
    for (int i = 0; i < 3; ++i) problem.sightings.push_back(loop.sighting(i, 1));
    FactorGraph graph;
    for (int i = 0; i < 3; ++i) graph.addPose(NodeId{i}, loop.truth()[static_cast<std::size_t>(i)], i == 0);
    graph.addLandmark(LandmarkId{1}, loop.objects()[1]);
    for (const auto& f : problem.movements) graph.add(f);
    for (const auto& f : problem.sightings) graph.add(f);
    ASSERT_TRUE(graph.optimize().usable);

    const LandmarkEstimate object = graph.landmark(LandmarkId{1});
    const State state{graph.pose(NodeId{1}),
                      graph.pose(NodeId{2}),
                      {object.position.x(), object.position.y(), object.position.z(), object.yaw}};
    const Eigen::MatrixXd dense = denseCovariance(problem, state);
    const auto landmarks = graph.landmarkCovariances();
    const auto first = poseCovariance(graph, 1), second = poseCovariance(graph, 2);
    ASSERT_TRUE(landmarks && first && second);
    expectClose(landmarks->at(LandmarkId{1}), dense.bottomRightCorner<4, 4>(), seed);
    expectClose(*first, dense.topLeftCorner<6, 6>(), seed);
    expectClose(*second, dense.block<6, 6>(6, 6), seed);
  }
}

TEST(MarginalCovariance, OfSomeLandmarksAsOfAll) {
  SimulatedLoop loop(3);
  FactorGraph graph = loop.graph();
  ASSERT_TRUE(graph.optimize().usable);
  const auto all = graph.landmarkCovariances();
  const auto some = graph.landmarkCovariances({LandmarkId{2}, LandmarkId{77}, LandmarkId{0}});
  ASSERT_TRUE(all && some);
  EXPECT_GT(all->size(), 2U);
  ASSERT_EQ(some->size(), 2U) << "one is not in the graph";
  for (const auto& [id, covariance] : *some) EXPECT_TRUE(covariance == all->at(id)) << id.value;
}

TEST(MarginalCovariance, UnknownYawIsUniform) {
  SimulatedLoop loop(1, 4);
  FactorGraph graph;
  for (int i = 0; i < 2; ++i) graph.addPose(NodeId{i}, loop.truth()[static_cast<std::size_t>(i)], i == 0);
  graph.add(loop.movement(0, 1));
  graph.addLandmark(LandmarkId{0}, loop.objects()[0]);
  for (int i = 0; i < 2; ++i) graph.add(loop.sighting(i, 0, false));
  const auto covariances = graph.landmarkCovariances();
  ASSERT_TRUE(covariances);
  const Eigen::Matrix4d& covariance = covariances->at(LandmarkId{0});
  EXPECT_NEAR(covariance(3, 3), M_PI * M_PI / 3, 1e-12);
  EXPECT_TRUE(covariance.topRightCorner(3, 1).isZero(0));
}

// Normalised squared errors of unbiased, honest estimates have a mean of their dimension d and, over n runs,
// a standard deviation of sqrt(2 d / n).
TEST(MarginalCovariance, ErrorsOfPosesAndLandmarksAgreeWithIt) {
  constexpr int kRuns = 60, kPose = 12;
  double of_pose = 0, of_landmark = 0;
  for (unsigned seed = 1; seed <= kRuns; ++seed) {
    SimulatedLoop loop(seed);
    FactorGraph graph = loop.graph();
    ASSERT_TRUE(graph.optimize().usable);
    const auto covariance = poseCovariance(graph, kPose);
    const auto landmarks = graph.landmarkCovariances();
    ASSERT_TRUE(covariance && landmarks);
    const Pose3 estimate = graph.pose(NodeId{kPose}), &truth = loop.truth()[kPose];
    const LandmarkEstimate landmark = graph.landmark(LandmarkId{2}), &object = loop.objects()[2];
    Vector6d error;
    error << estimate.translation() - truth.translation(),
        logSO3(estimate.linear() * truth.linear().transpose());
    Eigen::Vector4d landmark_error;
    landmark_error << landmark.position - object.position, wrapAngle(landmark.yaw - object.yaw);
    of_pose += error.dot(covariance->ldlt().solve(error));
    of_landmark += landmark_error.dot(landmarks->at(LandmarkId{2}).ldlt().solve(landmark_error));
  }
  EXPECT_NEAR(of_pose / kRuns, 6, 3.3 * std::sqrt(2 * 6.0 / kRuns));
  EXPECT_NEAR(of_landmark / kRuns, 4, 3.3 * std::sqrt(2 * 4.0 / kRuns));
}

TEST(MarginalCovariance, NoneForASingularProblem) {
  FactorGraph graph;
  graph.addPose(NodeId{0}, Pose3::Identity());  // nothing is held: the world may float
  graph.addLandmark(LandmarkId{0}, {{1, 0, 0}, 0});
  LandmarkFactor factor{NodeId{0}, LandmarkId{0}, {1, 0, 0}};
  graph.add(factor);
  EXPECT_FALSE(graph.landmarkCovariances());
}

// A pose that is held by next to nothing, and what it sees: of the matrix with a diagonal of ones one pivot is the ratio of
// both variances.
TEST(MarginalCovariance, NoneWhereNextToNothingHoldsIt) {
  const auto held = [](double ratio) {
    FactorGraph graph;
    graph.addPose(NodeId{0}, Pose3::Identity(), true);
    graph.addPose(NodeId{1}, Pose3::Identity());
    graph.addLandmark(LandmarkId{0}, {{1, 0, 0}, 0});
    graph.add(BetweenFactor{NodeId{0}, NodeId{1}, Pose3::Identity(), 1e-4 / ratio * Matrix6d::Identity()});
    LandmarkFactor factor{NodeId{1}, LandmarkId{0}, {1, 0, 0}};
    factor.covariance = 1e-4 * Eigen::Matrix4d::Identity();
    factor.robust_width = 0;
    graph.add(factor);
    return graph.landmarkCovariances();
  };
  EXPECT_FALSE(held(1e-14));
  const auto loose = held(1e-9);
  ASSERT_TRUE(loose);
  EXPECT_NEAR(loose->at(LandmarkId{0})(0, 0) / 1e5, 1, 1e-3);
}

}  // namespace
}  // namespace roomgraph::test
