// SPDX-License-Identifier: BSD-3-Clause
// Silent failure of graphs that cannot be evaluated.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "roomgraph/backend/planar_graph.h"
#include "simulated_loop.h"

// A graph that cannot be evaluated is a result, and silent.

namespace roomgraph::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class FailedEvaluation : public ::testing::Test {
 protected:
  // Whatever was printed, by any library.
  void SetUp() override { ::testing::internal::CaptureStderr(); }
  void TearDown() override { EXPECT_EQ(::testing::internal::GetCapturedStderr(), ""); }

  FactorGraph loopWith(double poison) {
    FactorGraph graph = loop.graph();
    BetweenFactor wrong = loop.movement(0, 12);
    wrong.a_from_b.translation().x() = poison;
    graph.add(wrong);
    return graph;
  }
  SimulatedLoop loop{1};
};

TEST_F(FailedEvaluation, HasNoCovariancesNoPriorAndNoChiSquared) {
  for (const double poison : {kNan, std::numeric_limits<double>::infinity()}) {
    FactorGraph graph = loopWith(poison);
    EXPECT_TRUE(std::isnan(graph.chiSquared()));
    EXPECT_FALSE(graph.landmarkCovariances());
    EXPECT_FALSE(graph.marginalize({.nodes = {NodeId{5}, NodeId{6}}}));
    EXPECT_FALSE(graph.optimize().usable);
  }
}

TEST_F(FailedEvaluation, LeavesThePosesAsTheyWere) {
  FactorGraph graph = loopWith(kNan);
  const Pose3 before = graph.pose(NodeId{7});
  graph.optimize();
  EXPECT_FALSE(graph.initializePoses());
  EXPECT_EQ(graph.pose(NodeId{7}).matrix(), before.matrix());
}

TEST_F(FailedEvaluation, InThePlaneToo) {
  PlanarGraph graph;
  graph.poses = {{NodeId{0}, {}}, {NodeId{1}, {1, 0, 0}}};
  graph.fixed = {NodeId{0}};
  graph.edges = {{NodeId{0}, NodeId{1}, {kNan, 0, 0}}};
  EXPECT_TRUE(std::isnan(chiSquared(graph)));
  EXPECT_FALSE(optimize(graph).usable);
  EXPECT_EQ(graph.poses.at(NodeId{1}).x, 1);
}

}  // namespace
}  // namespace roomgraph::test
