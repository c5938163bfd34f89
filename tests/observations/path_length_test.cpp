// SPDX-License-Identifier: BSD-3-Clause
// Length of paths with and without a step that nobody drove.
#include "roomgraph/observations/path_length.h"

#include <gtest/gtest.h>

namespace roomgraph {
namespace {

std::vector<StampedPose> pathThrough(const std::vector<Eigen::Vector3d>& points) {
  std::vector<StampedPose> path;
  for (const auto& point : points) path.push_back({static_cast<double>(path.size()), Pose3(Eigen::Translation3d(point))});
  return path;
}

TEST(PathLength, IsTheSumOfStepsInSpace) {
  EXPECT_NEAR(pathLength(pathThrough({{0, 0, 0}, {0.3, 0.4, 0}, {0.3, 0.4, 0.5}, {0, 0, 0.5}})), 1.5, 1e-12);
  EXPECT_EQ(pathLength({}), 0);
  EXPECT_EQ(pathLength(pathThrough({{1, 2, 3}})), 0);
}

TEST(PathLength, WhatLiesBetweenTwoSessionsWasNotDriven) {
  EXPECT_NEAR(pathLength(pathThrough({{0, 0, 0}, {0.5, 0, 0}, {3, 4, 0}, {3, 4.25, 0}})), 0.75, 1e-12);
}

}  // namespace
}  // namespace roomgraph
