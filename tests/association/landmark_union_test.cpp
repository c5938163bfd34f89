// SPDX-License-Identifier: BSD-3-Clause
// Fusion of two estimates of one object: against closed forms.
#include "roomgraph/association/landmark_union.h"

#include <gtest/gtest.h>

#include <cmath>

namespace roomgraph {
namespace {

TEST(LandmarkUnion, PlaceIsWeighedByInformation) {
  Landmark a, b;
  a.id = LandmarkId{3};
  b.id = LandmarkId{9};
  a.covariance = 0.01 * Eigen::Matrix4d::Identity();
  b.covariance = 0.04 * Eigen::Matrix4d::Identity();
  b.position = {1, 2, 0};
  a.observations = 3;
  b.observations = 1;
  b.shape.width = a.shape.width + 0.4;
  const Landmark out = fusedEstimates(a, b);
  EXPECT_EQ(out.id.value, 3);
  EXPECT_NEAR(out.position.x(), 0.2, 1e-12) << "(0 / .01 + 1 / .04) / (1 / .01 + 1 / .04)";
  EXPECT_NEAR(out.covariance(1, 1), 0.008, 1e-12) << "1 / (1 / .01 + 1 / .04)";
  EXPECT_NEAR(out.shape.width - a.shape.width, 0.1, 1e-12);
  EXPECT_EQ(out.observations, 4);
}

TEST(LandmarkUnion, AYawIsTurnedOnlyTowardsAnother) {
  Landmark without, with;
  without.covariance = with.covariance = 0.01 * Eigen::Matrix4d::Identity();
  with.yaw = 2.5;
  with.has_yaw = true;
  EXPECT_NEAR(fusedEstimates(without, with).yaw, 2.5, 1e-9);
  EXPECT_NEAR(fusedEstimates(with, without).yaw, 2.5, 1e-9);
  EXPECT_TRUE(fusedEstimates(without, with).has_yaw);
}

TEST(LandmarkUnion, LogOddsAdd) {
  EXPECT_NEAR(combinedExistence(0.8, 0.5), 0.8, 1e-12);
  EXPECT_NEAR(combinedExistence(0.8, 0.75), 12.0 / 13, 1e-12) << "odds 4 and 3";
  EXPECT_NEAR(combinedExistence(1, 1), 0.999, 1e-12) << "may still be overruled";
}

// Posteriors of 6 and 2 votes with half a vote of prior for each class; together 7 and 3.
TEST(LandmarkUnion, VotesForClassesAdd) {
  const std::map<std::string, double> a = {{"chair", 4.5 / 6}, {"sofa", 1.5 / 6}},
                                      b = {{"chair", 3.5 / 6}, {"sofa", 2.5 / 6}};
  const auto both = combinedClasses(a, 5, b, 5);
  EXPECT_NEAR(both.at("chair"), 7.5 / 11, 1e-12);
  EXPECT_NEAR(both.at("sofa"), 3.5 / 11, 1e-12);
}

}  // namespace
}  // namespace roomgraph
