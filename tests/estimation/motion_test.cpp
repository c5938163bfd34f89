// SPDX-License-Identifier: BSD-3-Clause
// Motion sources: covariance models, segments and order of preference.
#include "roomgraph/estimation/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

namespace roomgraph::test {
namespace {

const MotionNoise kNoise{
    .floor_m = 0.01, .per_m = 0.02, .floor_rad = 0.003, .per_rad = 0.04, .rad_per_m = 0.01};

TEST(MotionSource, CovarianceGrowsWithTheMovement) {
  MotionSource source(kNoise, false);
  source.add(0, Pose3::Identity(), 0, Matrix6d::Zero());
  source.add(1, poseFromYpr(0, 2, 0, 0.5, 0, 0), 0, Matrix6d::Zero());
  const auto movement = source.between(0, 1, 0);
  ASSERT_TRUE(movement);
  EXPECT_TRUE(movement->a_from_b.isApprox(poseFromYpr(0, 2, 0, 0.5, 0, 0), 1e-12));
  const double sigma_m = 0.01 + 0.02 * 2, sigma_rad = 0.003 + 0.04 * 0.5 + 0.01 * 2;
  Vector6d expected;
  expected << sigma_m, sigma_m, sigma_m, sigma_rad, sigma_rad, sigma_rad;
  EXPECT_LT((movement->covariance - Matrix6d(expected.cwiseAbs2().asDiagonal())).norm(), 1e-12);
}

TEST(MotionSource, PlanarSourceSaysNothingAboutHeightAndTilt) {
  MotionSource source(kNoise, true);
  source.add(0, Pose3::Identity(), 0, Matrix6d::Zero());
  source.add(1, poseFromYpr(1, 0, 0, 0, 0, 0), 0, Matrix6d::Zero());
  const Matrix6d covariance = source.between(0, 1, 0)->covariance;
  for (int i : {2, 3, 4}) EXPECT_GE(covariance(i, i), 0.25);
  for (int i : {0, 1, 5}) EXPECT_LT(covariance(i, i), 0.01);
}

TEST(MotionSource, StepCovariancesAreSummedOverTheSpan) {
  MotionSource source(kNoise, false);
  for (int i = 0; i <= 4; ++i) source.add(i, Pose3::Identity(), 0, 0.1 * i * Matrix6d::Identity());
  const double model = 0.01 * 0.01;
  EXPECT_NEAR(source.between(1, 3, 0)->covariance(0, 0), model + 0.2 + 0.3, 1e-12);
  EXPECT_NEAR(source.between(3, 1, 0)->covariance(0, 0), model + 0.2 + 0.3, 1e-12);
  EXPECT_NEAR(source.between(0, 4, 0)->covariance(0, 0), model + 1.0, 1e-12);
}

TEST(MotionSource, WithoutStepsItsModelIsAll) {
  MotionSource with(kNoise, false), without(kNoise, false);
  for (int i = 0; i <= 4; ++i) {
    const Pose3 pose = poseFromYpr(0.3 * i, 0.1 * i * i, 0, 0.2 * i, 0, 0);
    EXPECT_TRUE(with.add(i, pose, i / 3, Matrix6d::Zero()));
    EXPECT_TRUE(without.add(i, pose, i / 3));
  }
  EXPECT_FALSE(without.add(4, Pose3::Identity(), 1));
  for (const auto& [a, b] : {std::pair(0.0, 2.0), {0.5, 1.5}, {3, 4}, {3.2, 4.4}}) {
    const auto expected = with.between(a, b, 1), found = without.between(a, b, 1);
    ASSERT_TRUE(expected && found);
    EXPECT_EQ(found->covariance, expected->covariance);
    EXPECT_EQ(without.inLocalMap(a, b, 1)->covariance, with.inLocalMap(a, b, 1)->covariance);
  }
}

// The robot may have been carried while nothing was recorded.
TEST(MotionSource, WhatWheelsSayOfAPauseCountsAsUnknown) {
  MotionSource source(kNoise, false), other(kNoise, false);
  for (const double t : {0.0, 1.0, 3.0, 13.0, 14.0}) {
    source.add(t, Pose3::Identity(), 0);
    other.add(t, Pose3::Identity(), 0, Matrix6d::Zero());
  }
  const Matrix6d model = source.between(0, 3, 0)->covariance;
  EXPECT_LT(model.norm(), 1e-3) << "two seconds are no pause";
  for (const auto& [from, until, seconds] : {std::tuple(1.0, 14.0, 10.0), {14.0, 1.0, 10.0}, {5.0, 7.0, 2.0}, {3.0, 13.0, 10.0}, {12.0, 14.0, 1.0}})
    EXPECT_LT((source.between(from, until, 0)->covariance - other.between(from, until, 0)->covariance - unknownMovement(seconds).covariance).norm(), 1e-9) << from << ' ' << until;
  EXPECT_EQ(source.between(13, 14, 0)->covariance, model);
  EXPECT_TRUE(source.pausedWithin(1, 14) && source.pausedWithin(14, 1) && source.pausedWithin(5, 6) && source.pausedWithin(12, 14));
  EXPECT_FALSE(source.pausedWithin(0, 3) || source.pausedWithin(13, 14) || other.pausedWithin(1, 14));
  EXPECT_EQ(other.between(1, 14, 0)->covariance, model) << "matches hold across a pause";
  for (const Pose3& moved : {poseFromYpr(0.2, 0, 0, 0, 0, 0), poseFromYpr(0, 0, 0, 0.2, 0, 0)}) {
    MotionSource driving(kNoise, false);
    driving.add(0, Pose3::Identity(), 0);
    driving.add(10, moved, 0);
    EXPECT_LT(driving.between(0, 10, 0)->covariance.norm(), 1e-3) << "wheels that turned";
  }
}

TEST(MotionSource, NothingAcrossALossAndOutsideTheData) {
  MotionSource source(kNoise, false);
  EXPECT_FALSE(source.between(0, 1, 10));
  source.add(0, Pose3::Identity(), 0, Matrix6d::Zero());
  source.add(1, Pose3::Identity(), 0, Matrix6d::Zero());
  source.add(2, poseFromYpr(9, 0, 0, 0, 0, 0), 1, Matrix6d::Zero());
  EXPECT_TRUE(source.between(0, 1, 0));
  EXPECT_FALSE(source.between(0, 2, 0));
  EXPECT_FALSE(source.between(1, 1.5, 0));
  EXPECT_FALSE(source.between(2, 2.5, 0.1));
  EXPECT_FALSE(source.between(-1, 1, 0.5));
}

TEST(MotionSource, StampMustComeAfterTheLast) {
  MotionSource source(kNoise, false);
  EXPECT_TRUE(source.add(1, Pose3::Identity(), 0, Matrix6d::Zero()));
  EXPECT_FALSE(source.add(1, Pose3::Identity(), 0, Matrix6d::Zero()));
  EXPECT_FALSE(source.add(0.5, Pose3::Identity(), 0, Matrix6d::Zero()));
  EXPECT_EQ(source.poses().size(), 1u);
}

TEST(MotionSource, APoseBeyondTheLastHasTheErrorsOfTheTwoThatItIsDrawnFrom) {
  MotionSource source(kNoise, false);
  source.add(0, Pose3::Identity(), 0, Matrix6d::Zero());
  source.add(1, Pose3::Identity(), 0, 0.02 * Matrix6d::Identity());
  source.add(1.1, Pose3::Identity(), 0, 0.02 * Matrix6d::Identity());
  // b + r (b - a) with independent errors of variance v has v ((1 + r)^2 + r^2); one v is the match's own.
  const double r = 0.05 / 0.1, drawn = 0.02 * ((1 + r) * (1 + r) + r * r - 1);
  const double sped_up_m = 0.5 * 0.5 * 0.05 * 0.05, sped_up_rad = 0.5 * 1 * 0.05 * 0.05;
  const Matrix6d at_last = source.inLocalMap(1.1, 1.1, 0.2)->covariance, beyond = source.inLocalMap(1.1, 1.15, 0.2)->covariance;
  EXPECT_NEAR(beyond(0, 0) - at_last(0, 0), drawn + sped_up_m * sped_up_m, 1e-12);
  EXPECT_NEAR(beyond(5, 5) - at_last(5, 5), drawn + sped_up_rad * sped_up_rad, 1e-12);
  EXPECT_NEAR(source.between(1.1, 1.15, 0.2)->covariance(0, 0) - source.between(1.1, 1.1, 0.2)->covariance(0, 0),
              drawn + sped_up_m * sped_up_m, 1e-12);
}

// Where it was in between is not on the straight line; where it is after it is known as before.
TEST(MotionSource, WithinATimeInWhichNothingWasSeenAPoseMayBeAnywhere) {
  MotionSource source(kNoise, false);
  const Matrix6d step = 1e-4 * Matrix6d::Identity();
  for (const double t : {0.0, 0.2, 0.4, 10.4, 10.6}) source.add(t, poseFromYpr(t, 0, 0, 0, 0, 0), 0, step);
  const double away_m = 0.5 * 0.5 * 2 * 8, away_rad = 0.5 * 1 * 2 * 8, known = source.inLocalMap(0.2, 0.4, 0.2)->covariance(0, 0);
  const Matrix6d within = source.inLocalMap(0.2, 2.4, 0.2)->covariance;
  EXPECT_NEAR(within(0, 0) - known, away_m * away_m, 1e-9);
  EXPECT_NEAR(within(5, 5) - source.inLocalMap(0.2, 0.4, 0.2)->covariance(5, 5), away_rad * away_rad, 1e-9);
  for (const auto& [a, b] : {std::pair(0.2, 2.4), {2.4, 10.6}, {2.4, 0.2}})
    EXPECT_NEAR(source.between(a, b, 0.2)->covariance(0, 0), away_m * away_m, 1.0) << a << ' ' << b;
  EXPECT_NEAR(source.inLocalMap(2.4, 10.4, 0.2)->covariance(0, 0), known, 1e-9) << "the map may begin anywhere";
  EXPECT_LT(source.between(0.4, 10.6, 0.2)->covariance(0, 0), 2) << "the model alone";
  EXPECT_LT(source.between(0.1, 0.3, 0.2)->covariance(0, 0), 0.05) << "not of records as usual";
}

MotionSource movingBy(double metres) {
  MotionSource source(kNoise, true);
  source.add(0, Pose3::Identity(), 0, Matrix6d::Zero());
  source.add(1, poseFromYpr(metres, 0, 0, 0, 0, 0), 0, Matrix6d::Zero());
  return source;
}

// Front ends say "nothing known" of the step that does not exist: the first pose's, and that after a loss.
TEST(MotionSource, APoseThatBeginsASegmentIsKnownInItsOwnLocalMap) {
  MotionSource source(kNoise, false);
  source.add(0, Pose3::Identity(), 0, Matrix6d::Identity());
  source.add(1, Pose3::Identity(), 0, 0.02 * Matrix6d::Identity());
  source.add(2, Pose3::Identity(), 1, Matrix6d::Identity());
  source.add(3, Pose3::Identity(), 0, Matrix6d::Identity());
  const auto variance = [&](double t) { return source.inLocalMap(t, t, 0)->covariance(0, 0); };
  EXPECT_NEAR(variance(0), 1e-4, 1e-12);
  EXPECT_NEAR(variance(1), 1e-4 + 0.02, 1e-12);
  EXPECT_NEAR(variance(2), 1e-4, 1e-12);
  EXPECT_NEAR(variance(3), 1e-4 + 1, 1e-12) << "back in an earlier segment, which began elsewhere";
}

// With one pose there is no velocity to go on with.
TEST(MotionSource, BeyondThePoseThatBeginsASegmentNothingIsKnown) {
  MotionSource source(kNoise, false);
  for (int i = 0; i < 3; ++i) source.add(0.2 * i, poseFromYpr(0.1 * i, 0, 0, 0, 0, 0), i / 2, 1e-6 * Matrix6d::Identity());
  EXPECT_LT(std::sqrt(source.between(0.2, 0.2, 0.25)->covariance(0, 0)), 0.02);
  EXPECT_GT(std::sqrt(source.between(0.4, 0.6, 0.25)->covariance(0, 0)), 0.3);
}

MotionSource movingBy(double metres, double yaw, double variance) {
  MotionSource source(MotionNoise{.floor_m = 1e-5, .per_m = 0, .floor_rad = 1e-5, .per_rad = 0, .rad_per_m = 0}, false);
  source.add(0, Pose3::Identity(), 0, Matrix6d::Zero());
  source.add(1, poseFromYpr(metres, 0, 0, yaw, 0, 0), 0, variance * Matrix6d::Identity());
  return source;
}

TEST(Motion, SourcesWeighByTheirCovariances) {
  // Means of Gaussians: the weights are 1 / variance.
  const Motion motion{movingBy(1.00, 0.5, 4e-3), movingBy(1.01, 0.51, 1e-3), movingBy(1.03, 0.53, 2e-3)};
  const auto seen = motion.movement(0, 1, 0);
  ASSERT_TRUE(seen);
  const double weights = 250 + 1000 + 500;
  EXPECT_NEAR(seen->translation().x(), (250 * 1.00 + 1000 * 1.01 + 500 * 1.03) / weights, 1e-3);
  EXPECT_NEAR(planarPart(*seen).yaw, (250 * 0.50 + 1000 * 0.51 + 500 * 0.53) / weights, 1e-3);
}

TEST(Motion, ASourceAloneIsTakenAsItIs) {
  const MotionSource none(kNoise, true);
  const auto seen = [](const Motion& motion) { return motion.movement(0, 1, 0)->translation().x(); };
  EXPECT_NEAR(seen({movingBy(1), none, none}), 1, 1e-12);
  EXPECT_NEAR(seen({none, movingBy(2), none}), 2, 1e-12);
  EXPECT_NEAR(seen({none, none, movingBy(3)}), 3, 1e-12);
  EXPECT_FALSE((Motion{none, none, none}).movement(0, 1, 0));
}

TEST(Motion, WheelsThatSpinHardlyMoveWhatScansSee) {
  const MotionSource none(kNoise, true);
  const Motion slips{movingBy(1.5, 0, 1e-4), none, movingBy(1, 0, 1e-4)};
  EXPECT_NEAR(slips.movement(0, 1, 0)->translation().x(), 1, 0.01) << "half a metre is 35 standard deviations";
}

// Images that lead up from the floor: metres ahead, metres up, with a standard deviation of a millimetre (and radian) each.
MotionSource rising(double up) {
  MotionSource source(MotionNoise{.floor_m = 1e-5, .per_m = 0, .floor_rad = 1e-5, .per_rad = 0, .rad_per_m = 0}, false);
  source.add(0, Pose3::Identity(), 0, Matrix6d::Zero());
  source.add(1, poseFromYpr(1, 0, up, 0.2, 0, 0), 0, 1e-6 * Matrix6d::Identity());
  return source;
}

constexpr OnFloor kFloor{.sigma_z_m = 0.01, .sigma_tilt_rad = 0.005};

TEST(Motion, OnTheFloorHeightIsAMeanOfImagesAndFloor) {
  const MotionSource none(kNoise, true);
  const Motion motion{none, rising(0.01), none, kFloor};
  const double of_images = 1 / 1e-6, of_floor = 1 / (2 * 1e-4);  // two poses on the floor
  const double surprise = 1e-4 / (1e-6 + 2e-4) / 9, mean = 0.01 / (1 + of_floor * std::pow(1 + surprise, 2) / of_images);
  EXPECT_NEAR(motion.movement(0, 1, 0)->translation().z(), mean, 1e-6);
}

TEST(Motion, ARobotDoesNotLeaveTheFloorWhereImagesMislead) {
  const MotionSource none(kNoise, true), wheels = movingBy(0.97);
  const auto movement = [](const Motion& motion) { return *motion.movement(0, 1, 0); };
  EXPECT_NEAR(movement({wheels, rising(0.4), none}).translation().z(), 0.4, 0.01) << "handheld, with wheels";
  const Pose3 driven = movement({wheels, rising(0.4), none, kFloor});
  EXPECT_NEAR(driven.translation().z(), 0, 0.02);
  EXPECT_NEAR(driven.translation().x(), 0.97, 0.005) << "images that leave the floor are not what wheels are compared with";
  EXPECT_NEAR(planarPart(driven).yaw, 0, 0.01);
  const Pose3 alone = movement({none, rising(0.4), none, kFloor});
  EXPECT_NEAR(alone.translation().z(), 0, 0.02);
  EXPECT_NEAR(alone.translation().x(), 1, 1e-3) << "nothing else says how far it went";
  EXPECT_NEAR(planarPart(alone).yaw, 0.2, 1e-3);
}

// Turns do not add up like vectors: as seen from the misled one, wheels would turn about another axis.
TEST(Motion, WhatImagesTiltDoesNotComeBackWithTheYawOfWheels) {
  const MotionSource none(kNoise, true), wheels = movingBy(0.1);
  MotionSource tilting(kNoise, false);
  tilting.add(0, Pose3::Identity(), 0, Matrix6d::Zero());
  tilting.add(1, poseFromYpr(0.1, 0, 0, 0.8, 0.1, -0.2), 0, 1e-6 * Matrix6d::Identity());
  const Pose3 seen = *Motion{wheels, tilting, none, kFloor}.movement(0, 1, 0);
  EXPECT_NEAR(std::acos(seen.linear()(2, 2)), 0, 0.01);
}

TEST(Motion, ARobotDoesNotTiltWhereImagesMislead) {
  const MotionSource none(kNoise, true);
  MotionSource tilting(kNoise, false);
  tilting.add(0, Pose3::Identity(), 0, Matrix6d::Zero());
  tilting.add(1, poseFromYpr(0, 0, 0, 0.3, 0.1, -0.2), 0, 1e-6 * Matrix6d::Identity());
  const Pose3 seen = *Motion{none, tilting, none, kFloor}.movement(0, 1, 0);
  EXPECT_NEAR(std::acos(seen.linear()(2, 2)), 0, 0.02);
  EXPECT_NEAR(planarPart(seen).yaw, 0.3, 0.02);
}

TEST(MotionSource, RefinedPosesReplaceTheOld) {
  MotionSource source = movingBy(1);
  Trajectory better;
  better.add(0, Pose3::Identity());
  better.add(1, poseFromYpr(1.2, 0, 0, 0, 0, 0));
  source.refine(better);
  EXPECT_DOUBLE_EQ(source.between(0, 1, 0)->a_from_b.translation().x(), 1.2);
}

}  // namespace
}  // namespace roomgraph::test
