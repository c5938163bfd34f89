// SPDX-License-Identifier: BSD-3-Clause
// The share of errors of their own against errors drawn with a known one.
#include "own_share.h"

#include <gtest/gtest.h>

#include <random>

namespace roomgraph {
namespace {

// A wall with a return on each centimetre: every thirty have an error in common.
NeighbourErrors drawn(double own, std::mt19937& random) {
  std::normal_distribution<double> normal;
  Points2 points;
  std::vector<LineError> errors;
  double common = 0;
  for (int i = 0; i < 300; ++i) {
    if (i % 30 == 0) common = normal(random);
    points.emplace_back(0.01 * i, 1);
    errors.push_back({true, std::sqrt(own) * normal(random) + std::sqrt(1 - own) * common, Eigen::Vector2d::UnitY()});
  }
  return neighbourErrors(points, errors);
}

TEST(OwnShare, IsThatOfTheErrorsThatWereDrawn) {
  std::mt19937 random(1);
  for (const double share : {0.05, 0.3, 0.6, 1.0}) {
    OwnShare own;
    for (int scan = 0; scan < 300; ++scan) own.learn(drawn(share, random));
    // One pair of thirty has no error in common.
    EXPECT_NEAR(own.value(), share, 0.05) << share;
  }
}

TEST(OwnShare, IsTheUsualOneBeforeAnythingIsSeenAndStaysWithoutPairs) {
  OwnShare own;
  EXPECT_NEAR(own.value(), 0.2, 1e-12);
  own.learn({});
  EXPECT_NEAR(own.value(), 0.2, 1e-12);
  own.learn({0, 1e-3});
  EXPECT_NEAR(own.value(), 0.2, 1e-3) << "a single pair tells little";
}

TEST(OwnShare, FollowsALidarThatChanges) {
  std::mt19937 random(2);
  OwnShare own;
  for (int scan = 0; scan < 300; ++scan) own.learn(drawn(0.1, random));
  for (int scan = 0; scan < 200; ++scan) own.learn(drawn(0.9, random));
  EXPECT_NEAR(own.value(), 0.9, 0.06);
}

TEST(NeighbourErrors, AreOfReturnsOnOnePieceOfASurface) {
  const Eigen::Vector2d up = Eigen::Vector2d::UnitY(), aside = Eigen::Vector2d::UnitX();
  const auto of = [](const Points2& points, const std::vector<LineError>& errors) { return neighbourErrors(points, errors); };
  const auto pair = of({{0, 0}, {0.05, 0}}, {{true, 0.3, up}, {true, -0.1, up}});
  EXPECT_NEAR(pair.apart, 0.16 / 2, 1e-12);
  EXPECT_NEAR(pair.all, 0.10 / 2, 1e-12);
  EXPECT_EQ(of({{0, 0}, {0.15, 0}}, {{true, 0.3, up}, {true, -0.1, up}}).all, 0) << "apart";
  EXPECT_EQ(of({{0, 0}, {0.05, 0}}, {{true, 0.3, up}, {true, -0.1, aside}}).all, 0) << "around a corner";
  EXPECT_EQ(of({{0, 0}, {0.05, 0}}, {{true, 0.3, up}, {}}).all, 0) << "on no line";
}

}  // namespace
}  // namespace roomgraph
