// SPDX-License-Identifier: BSD-3-Clause
// Shortest paths over closures, confirmation by agreeing closures, and votes for the place of a segment.
#include <gtest/gtest.h>

#include <numeric>
#include <optional>
#include <random>

#include "closure_confirmation.h"
#include "closure_graph.h"
#include "place_votes.h"

namespace roomgraph {
namespace {

void expectSamePath(const ClosureGraph::Reached& is, const ClosureGraph::Reached& expected) {
  ASSERT_EQ(std::isinf(is.length_m), std::isinf(expected.length_m));
  if (std::isinf(expected.length_m)) return;
  EXPECT_NEAR(is.length_m, expected.length_m, 1e-9);
  EXPECT_NEAR(is.start_from_node.x, expected.start_from_node.x, 1e-9);
  EXPECT_NEAR(is.start_from_node.y, expected.start_from_node.y, 1e-9);
  EXPECT_NEAR(wrapAngle(is.start_from_node.yaw - expected.start_from_node.yaw), 0, 1e-9);
}

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

// Floyd and Warshall's shortest paths over all pairs, with the movements composed along.
TEST(ClosureGraph, ShortestPathsAreThoseOfAllPairs) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(-1, 1), length(0.5, 2);
  constexpr int kNodes = 14;
  ClosureGraph graph;
  std::vector<std::vector<ClosureGraph::Reached>> all(kNodes, std::vector<ClosureGraph::Reached>(kNodes));
  const auto join = [&](int a, int b, const Pose2& a_from_b, double way) {
    auto &there = all[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)],
         &back = all[static_cast<std::size_t>(b)][static_cast<std::size_t>(a)];
    if (way >= there.length_m) return;
    there = {way, a_from_b};
    back = {way, a_from_b.inverse()};
  };
  for (std::size_t i = 0; i < kNodes; ++i) all[i][i] = {0, {}};
  for (int i = 0; i < kNodes; ++i) {
    const Pose2 step{unit(random), unit(random), unit(random)};
    const double way = length(random);
    graph.addNode(i != 6, step, way);  // the run is cut before node 6
    if (i > 0 && i != 6) join(i - 1, i, step, way);
  }
  for (const auto& [a, b] : {std::pair{0, 4}, {1, 9}, {7, 13}}) {
    const Pose2 closure{unit(random), unit(random), unit(random)};
    graph.addClosure(a, b, closure, 0.3);
    join(a, b, closure, 0.3);
  }
  for (std::size_t k = 0; k < kNodes; ++k)
    for (std::size_t i = 0; i < kNodes; ++i)
      for (std::size_t j = 0; j < kNodes; ++j)
        if (const double way = all[i][k].length_m + all[k][j].length_m; way < all[i][j].length_m - 1e-12)
          all[i][j] = {way, all[i][k].start_from_node * all[k][j].start_from_node};
  EXPECT_EQ(graph.size(), kNodes);
  for (int i = 0; i < kNodes; ++i) {
    const auto reached = graph.reachedFrom(i);
    for (std::size_t j = 0; j < kNodes; ++j) {
      const auto& expected = all[static_cast<std::size_t>(i)][j];
      SCOPED_TRACE(testing::Message() << i << " to " << j);
      expectSamePath(reached[static_cast<int>(j)], expected);
    }
  }
}

// A graph that grows and loses nodes, beside one that only grows.
TEST(ClosureGraph, WhatIsTakenOutLeavesTheShortestPathsOfTheOthers) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(-1, 1), length(0.5, 2);
  ClosureGraph all, few, sparse;
  std::vector<int> there;
  std::vector<double> longer;
  const auto anyNode = [&] { return there[std::uniform_int_distribution<std::size_t>(0, there.size() - 1)(random)]; };
  for (int i = 0; i < 120; ++i) {
    const Pose2 step{unit(random), unit(random), unit(random)};
    const double way = length(random);
    for (auto* graph : {&all, &few, &sparse}) graph->addNode(i % 50 != 0, step, way);
    there.push_back(i);
    const int a = anyNode(), b = anyNode();
    const Pose2 closure{unit(random), unit(random), unit(random)};
    const double closure_way = length(random) / 4;
    if (a != b)
      for (auto* graph : {&all, &few, &sparse}) graph->addClosure(a, b, closure, closure_way);
    if (i % 3 == 0 || there.size() < 4) continue;
    const int taken = there[std::uniform_int_distribution<std::size_t>(0, there.size() - 2)(random)];
    few.remove(taken, 0);
    sparse.remove(taken, 1);
    std::erase(there, taken);
  }
  EXPECT_EQ(few.size(), 120);
  EXPECT_EQ(few.held(), static_cast<int>(there.size()));
  EXPECT_LT(few.held(), 50);
  for (const int from : there) {
    const auto expected = all.reachedFrom(from), is = few.reachedFrom(from), about = sparse.reachedFrom(from);
    for (const int to : there) {
      SCOPED_TRACE(testing::Message() << from << " to " << to);
      expectSamePath(is[to], expected[to]);
      EXPECT_GE(about[to].length_m, expected[to].length_m - 1e-9);
      if (!std::isinf(expected[to].length_m)) longer.push_back(about[to].length_m - expected[to].length_m);
      EXPECT_EQ(std::isinf(about[to].length_m), std::isinf(expected[to].length_m));
    }
  }
  EXPECT_LT(sparse.edges(), few.edges());
  EXPECT_LT(std::accumulate(longer.begin(), longer.end(), 0.0) / static_cast<double>(longer.size()), 1) << "the spare way";
}

TEST(ClosureGraph, WhatIsTakenOutIsOutOfReach) {
  ClosureGraph graph;
  for (int i = 0; i < 5; ++i) graph.addNode(true, {1, 0, 0}, 1);
  graph.remove(1, 0);
  EXPECT_TRUE(std::isinf(graph.reachedFrom(4)[1].length_m));
  EXPECT_TRUE(std::isinf(graph.reachedFrom(1)[4].length_m));
  graph.addClosure(1, 4, {}, 0.1);
  EXPECT_TRUE(std::isinf(graph.reachedFrom(4)[1].length_m));
  graph.addNode(true, {1, 0, 0}, 1);  // where node 1 was kept
  EXPECT_TRUE(std::isinf(graph.reachedFrom(4)[1].length_m));
  EXPECT_NEAR(graph.reachedFrom(5)[0].length_m, 5, 1e-12);
  EXPECT_NEAR(graph.reachedFrom(5)[0].start_from_node.x, -5, 1e-12);
}

TEST(ClosureGraph, WaysOfNoLengthAreWaysToo) {
  ClosureGraph graph;
  for (int i = 0; i < 4; ++i) graph.addNode(true, {}, 0);
  graph.remove(1, 0.5);
  EXPECT_EQ(graph.reachedFrom(3)[0].length_m, 0);
}

TEST(ClosureGraph, APathBeginsAtTheNearestOfSome) {
  ClosureGraph graph;
  for (int i = 0; i < 7; ++i) graph.addNode(i != 5, {1, 0, 0}, 1);
  const auto reached = graph.reachedFromAny({0, 4});
  EXPECT_EQ(reached[1].start, 0);
  EXPECT_EQ(reached[3].start, 4);
  EXPECT_NEAR(reached[3].length_m, 1, 1e-12);
  EXPECT_NEAR(reached[3].start_from_node.x, -1, 1e-12);
  EXPECT_EQ(reached[6].start, -1);
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

TEST_F(Confirmation, AgreementFollowsFromTheMovementsInBetween) {
  // Scans a and b of both passes in frames of their own; a2 and b2 stand elsewhere and turned.
  const Pose2 drift{2, -1, 0.7}, a1{1, 2, 0.3}, a2{2.5, 2.2, 1.1}, a1_from_b1{0.2, -0.1, 0.4}, b1_from_b2{1, 0.5, -0.6};
  const Pose2 b1 = drift * a1 * a1_from_b1, b2 = b1 * b1_from_b2;
  const std::vector<WayPoint> way{{a1, 1, 0}, {a2, 3, 0}, {b1, 40, 0}, {b2, 42, 0}};
  const Closure first{0, 2, a1_from_b1, Eigen::Matrix3d::Identity(), 40};
  const Pose2 a2_from_b2 = a2.inverse() * (a1 * a1_from_b1 * b1_from_b2);
  const auto second = [&](const Pose2& error) {
    return Closure{1, 3, a2_from_b2 * error, Eigen::Matrix3d::Identity(), 40};
  };
  EXPECT_TRUE(agree(first, second({}), way, rule_));
  // Compared over 4 m of way: 0.15 m + 4 * 0.02 m, and 0.05 rad + a tenth of that 0.08.
  EXPECT_TRUE(agree(first, second({0.22, 0, 0}), way, rule_));
  EXPECT_FALSE(agree(first, second({0.24, 0, 0}), way, rule_));
  EXPECT_FALSE(agree(first, second({0, 0, 0.2}), way, rule_));
  auto cut = way;
  cut[3].segment = 1;
  EXPECT_FALSE(agree(first, second({}), cut, rule_)) << "the movement between them is not known";
  auto far = way;
  far[1].path_m = 9.5;
  EXPECT_FALSE(agree(first, second({}), far, rule_)) << "beyond the reach";
}

TEST_F(Confirmation, WhatWaitedTooLongDoesNotCount) {
  for (auto& w : way_) w.odom_from_robot.yaw = 0;
  ClosureConfirmation confirmation;
  confirmation.add(right(0), way_, rule_);
  EXPECT_TRUE(confirmation.add(right(9), way_, rule_).empty()) << "9 m later: the first one is given up";
  EXPECT_TRUE(confirmation.add(right(8), way_, rule_).empty()) << "would agree with it";
  EXPECT_EQ(confirmation.add(right(7), way_, rule_).size(), 3u);
}

TEST_F(Confirmation, OneSpotIsNotEnough) {
  ClosureConfirmation confirmation;
  const std::vector<WayPoint> still(4, WayPoint{{1, 1, 0}, 5, 0});
  const std::vector<Closure> same{{0, 1, {}, Eigen::Matrix3d::Identity(), 50},
                                  {0, 2, {}, Eigen::Matrix3d::Identity(), 50},
                                  {0, 3, {}, Eigen::Matrix3d::Identity(), 50}};
  for (const Closure& closure : same) EXPECT_TRUE(confirmation.add(closure, still, rule_).empty());
}

// Asked once enough agree, of all of them; the others need not be found again.
TEST_F(Confirmation, ThoseThatFitElsewhereWaitOn) {
  for (auto& w : way_) w.odom_from_robot.yaw = 0;
  ClosureConfirmation confirmation;
  std::vector<std::size_t> asked;
  const auto answer = [&](bool have_rival) {
    return [&asked, have_rival](const std::vector<Closure>& agreeing) {
      EXPECT_EQ(agreeing.front().a, 2 + static_cast<int>(asked.size()) + 1);
      asked.push_back(agreeing.size());
      return have_rival;
    };
  };
  for (const int i : {1, 2}) EXPECT_TRUE(confirmation.add(right(i), way_, rule_, answer(true)).empty());
  EXPECT_TRUE(confirmation.add(right(3), way_, rule_, answer(true)).empty());
  EXPECT_EQ(confirmation.add(right(4), way_, rule_, answer(false)).size(), 3u);
  EXPECT_EQ(asked, (std::vector<std::size_t>{3, 3}));
}

// Each a little farther back along the wall than the last one: no step is large, but together they contradict the odometry.
TEST_F(Confirmation, AClosureThatSlidesContradictsThoseBefore) {
  for (auto& w : way_) w.odom_from_robot.yaw = 0;
  ClosureConfirmation confirmation;
  EXPECT_FALSE(confirmation.contradicts(right(0), way_, rule_)) << "nothing was accepted yet";
  const auto slid = [](int i, double by_m) {
    Closure out = right(i);
    out.a_from_b.x -= by_m;
    return out;
  };
  for (const int i : {1, 2, 3}) confirmation.accept(right(i), way_, rule_);
  EXPECT_FALSE(confirmation.contradicts(right(4), way_, rule_));
  EXPECT_FALSE(confirmation.contradicts(slid(4, 0.18), way_, rule_));
  confirmation.accept(slid(4, 0.18), way_, rule_);
  EXPECT_TRUE(confirmation.contradicts(slid(5, 0.4), way_, rule_));
  confirmation.accept(slid(5, 0.3), way_, rule_);
  confirmation.accept(slid(5, 0.3), way_, rule_);
  EXPECT_FALSE(confirmation.contradicts(slid(5, 0.3), way_, rule_)) << "three of six agree with it";
  auto far = way_;
  for (std::size_t i = 16; i < far.size(); ++i) far[i].path_m += 10;
  EXPECT_FALSE(confirmation.contradicts(slid(6, 2), far, rule_)) << "they are farther back than the reach";
}

TEST_F(Confirmation, ClosuresToOtherPlacesContradictNothing) {
  ClosureConfirmation confirmation;
  for (const int b : {16, 17, 18}) confirmation.accept({0, b, {}, Eigen::Matrix3d::Identity(), 50}, way_, rule_);
  EXPECT_FALSE(confirmation.contradicts(right(9), way_, rule_)) << "9 m from there, which is beyond the reach";
}

// A segment of 40 scans, half a metre apart along x in its own frame, which lies at `kPlace` in world.
class Votes : public ::testing::Test {
 protected:
  Votes() {
    for (int i = 0; i < 40; ++i) way_.push_back({{0.5 * i, 0, 0}, 0.5 * i, 1});
  }
  // Scan b is seen from older scan `a` at a place in world, off by `error`.
  std::vector<Closure> vote(int b, const Pose2& error = {}, int a = 0, int piece = 0) {
    const Pose2 world_from_b = error * kPlace * way_[static_cast<std::size_t>(b)].odom_from_robot;
    return votes_.add({a, b, places_[static_cast<std::size_t>(a)].inverse() * world_from_b, Eigen::Matrix3d::Identity(), 0}, piece, way_,
                      [this](int scan) { return std::optional(places_[static_cast<std::size_t>(scan)]); });
  }
  const Pose2 kPlace{4, -7, 2};
  std::vector<Pose2> places_ = {{}, {1, 2, 0.3}, {2, 2, 0.6}, {-5, 1, 3}};
  std::vector<WayPoint> way_;
  PlaceVotes votes_;
};

TEST_F(Votes, EightScansOverThreeMetresAreBelieved) {
  for (int b = 0; b < 7; ++b) EXPECT_TRUE(vote(b, {0.1, 0.05, 0.01}, b % 4).empty()) << b;
  const auto believed = vote(7);
  ASSERT_EQ(believed.size(), 8u);
  for (int b = 0; b < 8; ++b) EXPECT_EQ(believed[static_cast<std::size_t>(b)].b, b);
  votes_.forget(0);
  EXPECT_TRUE(vote(8).empty()) << "they count once";
}

TEST_F(Votes, ManyMatchesOfOneScanAreOne) {
  for (int i = 0; i < 16; ++i) EXPECT_TRUE(vote(i < 8 ? 0 : 8).empty());
}

TEST_F(Votes, ScansOfOneSpotAreNotBelieved) {
  for (std::size_t i = 0; i < 40; ++i) way_[i].path_m = 0.05 * static_cast<double>(i);
  for (int b = 0; b < 40; ++b) EXPECT_TRUE(vote(b).empty()) << b;
}

TEST_F(Votes, OtherPlacesAreOutweighedByFourTimesAsMany) {
  vote(0, {3, 0, 0}), vote(1, {0, 0, 0.5}), vote(2, {0, -3, 0});
  for (int b = 3; b < 14; ++b) EXPECT_TRUE(vote(b).empty()) << b;
  EXPECT_EQ(vote(14).size(), 12u);
}

// One by chance every few metres, each somewhere within three metres.
TEST_F(Votes, WhatLiesLongAgoSaysNothing) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> off(-3, 3);
  for (std::size_t i = 0; i < 40; ++i) way_[i].path_m = way_[i].odom_from_robot.x = 2.2 * static_cast<double>(i);
  for (int b = 0; b < 40; ++b) EXPECT_TRUE(vote(b).empty()) << b << ": never more than eight within fifteen metres";
  for (std::size_t i = 0; i < 40; ++i) way_[i].path_m = 100 + (way_[i].odom_from_robot.x = 1.2 * static_cast<double>(i));
  for (int b = 0; b < 40; ++b) EXPECT_TRUE(vote(b, {off(random), off(random), 0}).empty()) << b;
}

TEST_F(Votes, OfAnotherSegmentOrPieceTheySayNothing) {
  for (int b = 0; b < 7; ++b) vote(b);
  for (std::size_t i = 7; i < 40; ++i) way_[i].segment = 2;
  for (int b = 7; b < 14; ++b) {
    EXPECT_TRUE(vote(b).empty()) << b;
    EXPECT_TRUE(vote(b, {9, 9, 1}, 0, 1).empty()) << "which lies anywhere else";
  }
  EXPECT_EQ(vote(14).size(), 8u);
}

TEST_F(Votes, PlacesAreThoseOfNow) {
  for (int b = 0; b < 7; ++b) vote(b, {}, b % 2);
  const Pose2 moved{3, 1, 0.2};
  places_[0] = moved * places_[0], places_[1] = moved * places_[1];
  EXPECT_EQ(vote(7, moved).size(), 8u);
}

}  // namespace
}  // namespace roomgraph
