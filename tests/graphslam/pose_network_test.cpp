// SPDX-License-Identifier: BSD-3-Clause
// Pose networks against optima known in closed form and against the truth.
#include "roomgraph/graphslam/pose_network.h"

#include <gtest/gtest.h>

namespace roomgraph {
namespace {

BetweenFactor edge(int a, int b, const Pose3& a_from_b, double variance, double robust_width = 0) {
  return {NodeId{a}, NodeId{b}, a_from_b, variance * Matrix6d::Identity(), robust_width};
}

Pose3 along(double x) {
  return poseFromYpr(x, 0, 0, 0, 0, 0);
}

double xOf(const PoseNetwork& network, int id) {
  return network.poses.at(NodeId{id}).translation().x();
}

// Two steps of 1 m with variance 1 and a direct measurement of 2.3 m with variance 1: of the 0.3 m that they
// disagree each takes a third.
TEST(PoseNetwork, SharesADisagreementByVariance) {
  for (const bool planar : {true, false}) {
    PoseNetwork network{{{NodeId{0}, along(0)}, {NodeId{1}, along(1)}, {NodeId{2}, along(2)}},
                        {edge(0, 1, along(1), 1), edge(1, 2, along(1), 1), edge(0, 2, along(2.3), 1)}};
    network.planar = planar;
    const SolveReport report = optimize(network);
    EXPECT_TRUE(report.usable) << report.message;
    EXPECT_NEAR(xOf(network, 0), 0, 1e-9);
    EXPECT_NEAR(xOf(network, 1), 1.1, 1e-6);
    EXPECT_NEAR(xOf(network, 2), 2.2, 1e-6);
    EXPECT_NEAR(report.final_cost, 3 * 0.1 * 0.1 / 2, 1e-6);
  }
}

TEST(PoseNetwork, ARobustLossLeavesAWrongClosureOut) {
  PoseNetwork network{{}, {}};
  for (int i = 0; i <= 5; ++i) network.poses[NodeId{i}] = along(i);
  for (int i = 0; i < 5; ++i) network.edges.push_back(edge(i, i + 1, along(1), 1e-4));
  network.edges.push_back(edge(0, 5, along(1), 1e-4, 1));
  optimize(network);
  EXPECT_NEAR(xOf(network, 5), 5, 0.01);
  network.edges.back().robust_width = 0;
  optimize(network);
  EXPECT_NEAR(xOf(network, 5), 5 - 4. * 5 / 6, 1e-4);  // the six edges share it
}

// A square of exact movements with wrong first guesses.
TEST(PoseNetwork, FindsTheTruthOfExactMovements) {
  for (const bool planar : {true, false}) {
    std::vector<Pose3> truth{Pose3::Identity()};
    const Pose3 step = planar ? poseFromYpr(1, 0.1, 0, 0.8, 0, 0) : poseFromYpr(1, 0.1, 0.2, 0.8, 0.2, -0.1);
    for (int i = 1; i < 8; ++i) truth.push_back(truth.back() * step);
    PoseNetwork network;
    network.planar = planar;
    for (int i = 0; i < 8; ++i) {
      const Pose3 wrong = truth[static_cast<std::size_t>(i)] * poseFromYpr(0.1 * i, -0.05 * i, 0, 0.05 * i, 0, 0);
      network.poses[NodeId{i}] = wrong;
      if (i > 0) network.edges.push_back(edge(i - 1, i, step, 1e-4));
    }
    network.edges.push_back(edge(7, 0, truth.back().inverse(), 1e-4));
    EXPECT_TRUE(optimize(network, {.max_iterations = 100, .function_tolerance = 1e-14}).usable);
    for (int i = 0; i < 8; ++i)
      EXPECT_LT((network.poses.at(NodeId{i}).matrix() - truth[static_cast<std::size_t>(i)].matrix()).norm(), 1e-4) << i;
  }
}

TEST(PoseNetwork, AnEdgeToNowhereIsAnError) {
  PoseNetwork network{{{NodeId{0}, along(0)}}, {edge(0, 1, along(1), 1)}};
  EXPECT_THROW(optimize(network), std::out_of_range);
}

}  // namespace
}  // namespace roomgraph
