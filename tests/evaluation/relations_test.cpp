// SPDX-License-Identifier: BSD-3-Clause
// Relation errors against values worked out by hand.
#include "roomgraph/evaluation/relations.h"

#include <gmock/gmock.h>

#include <cmath>

#include "errors_of.h"
#include "roomgraph/core/errors.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

using ::testing::HasSubstr;
using test::messageOf;
using test::TemporaryFolder;

TEST(Relations, ReadsAnglesInTheOrderRollPitchYaw) {
  const TemporaryFolder folder;
  const auto relations = readRelations(folder.write("a.relations", "# c\n1 2 .5 -1 2 0.1 0.2 0.3\n"));
  ASSERT_EQ(relations.size(), 1u);
  EXPECT_EQ(relations[0].t1, 1);
  EXPECT_EQ(relations[0].t2, 2);
  EXPECT_TRUE(relations[0].pose.isApprox(poseFromYpr(0.5, -1, 2, 0.3, 0.2, 0.1), 1e-12));
}

TEST(Relations, BadLinesAndEmptyFiles) {
  const TemporaryFolder folder;
  EXPECT_THAT(messageOf<InputError>([&] { readRelations(folder.write("a", "1 2 3 4 5 6 7 8\n1 2 3\n")); }),
              HasSubstr("a:2: expected 8 columns"));
  EXPECT_THAT(messageOf<InputError>([&] { readRelations(folder.write("b", "\n")); }),
              HasSubstr("holds no relation"));
}

// Drives 1 m/s along x while the world frame is turned: relations do not depend on it.
Trajectory drive(const Pose3& world_from_start, double speed) {
  Trajectory out;
  for (int i = 0; i <= 10; ++i) out.add(i, world_from_start * toPose3(Pose2{speed * i, 0, 0}));
  return out;
}

TEST(Relations, HandComputedErrors) {
  std::vector<Relation> relations;
  relations.push_back({2, 5, toPose3(Pose2{3, 0, 0})});                // right
  relations.push_back({2.5, 3.75, toPose3(Pose2{1.25, 0, 0})});        // right, between poses
  relations.push_back({0, 1, toPose3(Pose2{1, 0.3, 0})});              // .3 m
  relations.push_back({1, 0, toPose3(Pose2{-1, 0, M_PI / 180 * 2})});  // 2 deg; backwards in time
  relations.push_back({9, 11, toPose3(Pose2{2, 0, 0})});               // ends after the estimate
  for (const auto& start : {Pose3(Pose3::Identity()), poseFromYpr(5, -3, 0, 2.5, 0, 0)}) {
    const auto errors = evaluateRelations(relations, drive(start, 1));
    EXPECT_EQ(errors.used, 4);
    EXPECT_EQ(errors.missing, 1);
    EXPECT_NEAR(errors.trans_m.mean, 0.3 / 4, 1e-9);
    EXPECT_NEAR(errors.trans_m.max, 0.3, 1e-9);
    EXPECT_NEAR(errors.trans_m.squared_mean, 0.09 / 4, 1e-9);
    EXPECT_NEAR(errors.trans_m.std, std::sqrt((3 * 0.075 * 0.075 + 0.225 * 0.225) / 4), 1e-9);
    EXPECT_NEAR(errors.rot_deg.mean, 0.5, 1e-6);
    EXPECT_NEAR(errors.rot_deg.squared_mean, 1, 1e-6);
  }
}

TEST(Relations, ScaledEstimateIsNotForgiven) {
  const auto errors = evaluateRelations({{1, 4, toPose3(Pose2{3, 0, 0})}}, drive(Pose3::Identity(), 1.1));
  EXPECT_NEAR(errors.trans_m.mean, 0.3, 1e-9);
}

TEST(Relations, StampRoundedOutsideTheEndsIsUsed) {
  const auto errors =
      evaluateRelations({{-0.01, 10.01, toPose3(Pose2{10.02, 0, 0})}}, drive(Pose3::Identity(), 1));
  EXPECT_EQ(errors.used, 1);
  EXPECT_NEAR(errors.trans_m.mean, 0, 1e-9);
}

TEST(Relations, EmptyEstimate) {
  const auto errors = evaluateRelations({{1, 2, Pose3::Identity()}}, {});
  EXPECT_EQ(errors.used, 0);
  EXPECT_EQ(errors.missing, 1);
}

}  // namespace
}  // namespace roomgraph
