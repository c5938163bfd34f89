// SPDX-License-Identifier: BSD-3-Clause
// Shortest paths over closures, and confirmation by agreeing closures.
#include <gtest/gtest.h>

#include "closure_confirmation.h"
#include "closure_graph.h"

namespace roomgraph {
namespace {

TEST(ClosureGraph, ShortestPathsUseClosures) {
  ClosureGraph graph;
  for (int i = 0; i < 5; ++i) graph.addNode(true, {1, 0, 0}, 1);
  auto reached = graph.reachedFrom(4);
  EXPECT_NEAR(reached[0].length_m, 4, 1e-12);
  EXPECT_NEAR(reached[0].start_from_node.x, -4, 1e-12);
  graph.addClosure(0, 4, {0.5, 0, 0}, 0.3);
  reached = graph.reachedFrom(4);
  EXPECT_NEAR(reached[0].length_m, 0.3, 1e-12);
  EXPECT_NEAR(reached[0].start_from_node.x, -0.5, 1e-12);
  EXPECT_NEAR(reached[1].length_m, 1.3, 1e-12);
}

TEST(ClosureGraph, UnconnectedSegmentsAreOutOfReach) {
  ClosureGraph graph;
  graph.addNode(false, {}, 0);
  graph.addNode(false, {}, 0);
  EXPECT_TRUE(std::isinf(graph.reachedFrom(1)[0].length_m));
}

class Confirmation : public ::testing::Test {
 protected:
  // Out along x for 10 m, and the same way again at the end: scan 20 + i is where scan i was.
  Confirmation() {
    for (int i = 0; i < 10; ++i) way_.push_back({{1.0 * i, 0, 0}, 1.0 * i, 0});
    for (int i = 0; i < 10; ++i) way_.push_back({{1.0 * i + 0.4, 3, 0.1}, 50 + 1.0 * i, 0});
  }
  // The matcher drifted to one side but moved straight in its own frame on both passes; the second pass has
  // its own x.
  static Closure right(int i) { return {i, 10 + i, {0, 0, 0}, Eigen::Matrix3d::Identity(), 50}; }
  std::vector<WayPoint> way_;
  const ConfirmationRule rule_{.agreeing = 3, .travelled_m = 1};
};

TEST_F(Confirmation, NeedsThreeThatAgree) {
  for (auto& w : way_) w.odom_from_robot.yaw = 0;
  ClosureConfirmation confirmation;
  EXPECT_TRUE(confirmation.add(right(1), way_, rule_).empty());
  EXPECT_TRUE(confirmation.add(right(2), way_, rule_).empty());
  EXPECT_EQ(confirmation.add(right(3), way_, rule_).size(), 3u);
}

TEST_F(Confirmation, ContradictingOnesAreHeldBack) {
  for (auto& w : way_) w.odom_from_robot.yaw = 0;
  ClosureConfirmation confirmation;
  confirmation.add(right(1), way_, rule_);
  Closure wrong = right(2);
  wrong.a_from_b.x += 0.6;
  EXPECT_FALSE(agree(right(1), wrong, way_, rule_));
  EXPECT_TRUE(confirmation.add(wrong, way_, rule_).empty());
  EXPECT_TRUE(confirmation.add(right(3), way_, rule_).empty());
}

TEST_F(Confirmation, OneSpotIsNotEnough) {
  ClosureConfirmation confirmation;
  const std::vector<WayPoint> still(4, WayPoint{{1, 1, 0}, 5, 0});
  const std::vector<Closure> same{{0, 1, {}, Eigen::Matrix3d::Identity(), 50},
                                  {0, 2, {}, Eigen::Matrix3d::Identity(), 50},
                                  {0, 3, {}, Eigen::Matrix3d::Identity(), 50}};
  for (const Closure& closure : same) EXPECT_TRUE(confirmation.add(closure, still, rule_).empty());
}

}  // namespace
}  // namespace roomgraph
