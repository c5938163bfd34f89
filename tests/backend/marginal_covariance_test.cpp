// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include <gtest/gtest.h>

#include "residual_specimens.h"
#include "simulated_loop.h"

namespace roomgraph::testing {
namespace {

// State of the small problem: poses 1 and 2 (pose 0 is held) and one object.
struct State {
  Pose3 first, second;
  std::vector<double> object;
};

// Pose blocks move as t + dt, exp(2 d) q, as the manifold of the solver does.
State moved(const State& state, const Eigen::VectorXd& delta) {
  const auto move = [](const Pose3& pose, const Vector6d& d) {
    Pose3 out = pose;
    out.translation() += d.head<3>();
    out.linear() = expSO3(2 * d.tail<3>()) * pose.linear();
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
      evaluate(*costOf<BetweenResidual, 6, 3, 4, 3, 4>(f), blocks);
    }
    for (const auto& f : sightings) {
      std::vector<Block> blocks = blocksOf(*poses[f.node.value]);
      blocks.push_back({state.object});
      evaluate(*costOf<LandmarkResidual, 4, 3, 4, 4>(f), blocks);
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

TEST(MarginalCovariance, IsTheBlockOfTheDenseInverse) {
  SimulatedLoop loop(4, 8);
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
  const Eigen::Matrix4d expected = denseCovariance(problem, state).bottomRightCorner<4, 4>();
  const auto covariances = graph.landmarkCovariances();
  ASSERT_TRUE(covariances);
  EXPECT_LT((covariances->at(LandmarkId{1}) - expected).norm(), 1e-5 * expected.norm())
      << covariances->at(LandmarkId{1}) << "\n\n"
      << expected;
}

TEST(MarginalCovariance, NoneForASingularProblem) {
  FactorGraph graph;
  graph.addPose(NodeId{0}, Pose3::Identity());  // nothing is held: the world may float
  graph.addLandmark(LandmarkId{0}, {{1, 0, 0}, 0});
  LandmarkFactor factor{NodeId{0}, LandmarkId{0}, {1, 0, 0}};
  graph.add(factor);
  EXPECT_FALSE(graph.landmarkCovariances());
}

}  // namespace
}  // namespace roomgraph::testing
