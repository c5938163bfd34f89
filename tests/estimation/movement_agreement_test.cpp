// SPDX-License-Identifier: BSD-3-Clause
// Votes of three sensors by hand, and angles between the ways they saw.
#include "roomgraph/estimation/movement_agreement.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>

#include "roomgraph/core/random.h"

namespace roomgraph::test {
namespace {

std::optional<Movement> seenAs(double x, double y, double yaw, double sigma = 0.005) {
  Vector6d sigmas;
  sigmas << sigma, sigma, 0.5, 0.5, 0.5, sigma;
  return Movement{toPose3(Pose2{x, y, yaw}), Matrix6d(sigmas.cwiseAbs2().asDiagonal())};
}

TEST(MovementAgreement, TheOneThatDiffersFromBothOthersContradicts) {
  MovementAgreement agreement;
  agreement.compare(0, 1, {seenAs(0.2, 0, 0.01), seenAs(0.201, 0.001, 0.012), seenAs(0.5, 0.05, 0.1)});
  ASSERT_EQ(agreement.contradictions().size(), 1u);
  const Contradiction& one = agreement.contradictions()[0];
  EXPECT_EQ(one.sensor, MotionSensor::kWheels);
  EXPECT_EQ(one.from_t, 0);
  EXPECT_EQ(one.until_t, 1);
  EXPECT_NEAR(one.off_m, std::hypot(0.3, 0.05), 0.01);
  EXPECT_NEAR(one.off_rad, 0.09, 0.01);
}

TEST(MovementAgreement, WhatGoesOnIsOneContradictionWhateverOthersDo) {
  MovementAgreement agreement;
  const auto still = seenAs(0, 0, 0), moving = seenAs(0.3, 0, 0), turning = seenAs(0, 0, 0.4);
  agreement.compare(0, 1, {still, still, moving});
  agreement.compare(1, 2, {still, still, turning});
  agreement.compare(2, 3, {still, still, still});
  agreement.compare(3, 4, {moving, still, still});
  agreement.compare(4, 5, {still, still, moving});
  ASSERT_EQ(agreement.contradictions().size(), 3u);
  EXPECT_EQ(agreement.contradictions()[0].until_t, 2);
  EXPECT_NEAR(agreement.contradictions()[0].off_m, 0.3, 1e-9);
  EXPECT_NEAR(agreement.contradictions()[0].off_rad, 0.4, 1e-9);
  EXPECT_EQ(agreement.contradictions()[1].sensor, MotionSensor::kLidar);
  EXPECT_EQ(agreement.contradictions()[2].from_t, 4);
}

// Which is wrong is not known.
TEST(MovementAgreement, OfTwoEachContradictsTheOther) {
  using enum MotionSensor;
  MovementAgreement agreement;
  const auto still = seenAs(0, 0, 0), moving = seenAs(0.3, 0, 0);
  agreement.compare(0, 1, {std::nullopt, moving, still});
  agreement.compare(1, 2, {std::nullopt, moving, still});
  agreement.compare(2, 3, {std::nullopt, moving, moving});
  agreement.compare(3, 4, {moving, std::nullopt, still});
  agreement.compare(4, 5, {moving, moving, still});
  agreement.compare(5, 6, {std::nullopt, std::nullopt, still});
  agreement.compare(6, 7, {still, moving, std::nullopt});
  const auto& found = agreement.contradictions();
  ASSERT_EQ(found.size(), 4u);
  const std::array<std::pair<MotionSensor, std::optional<MotionSensor>>, 4> expected = {
      {{kCamera, kWheels}, {kWheels, kLidar}, {kWheels, std::nullopt}, {kLidar, kCamera}}};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(std::pair(found[i].sensor, found[i].only_other), expected[i]) << i;
  EXPECT_EQ(found[0].from_t, 0);
  EXPECT_EQ(found[0].until_t, 2);
  EXPECT_NEAR(found[0].off_m, 0.3, 1e-9);
}

TEST(MovementAgreement, NobodyIsToBlameWhereAllDifferOrTheDifferenceIsExpected) {
  MovementAgreement agreement;
  agreement.compare(0, 1, {seenAs(0, 0, 0), seenAs(0.3, 0, 0), seenAs(-0.3, 0, 0)});
  agreement.compare(1, 2, {seenAs(0, 0, 0), seenAs(0.3, 0, 0, 0.2), std::nullopt});
  agreement.compare(2, 3, {seenAs(0, 0, 0), seenAs(0, 0, 0), seenAs(0.3, 0, 0, 0.2)});
  agreement.compare(3, 4, {seenAs(0, 0, 0), seenAs(0.1, 0, 0), seenAs(0.03, 0, 0, 0.05)});
  agreement.compare(3, 4, {seenAs(0, 0, 0, 1e-4), seenAs(0, 0, 0, 1e-4), seenAs(0.02, 0, 0, 1e-4)});
  EXPECT_TRUE(agreement.contradictions().empty());
}

// Half a circle: a sensor that is mounted backwards.
TEST(MovementAgreement, AWayThatIsTurnedTellsBySoMuch) {
  using enum MotionSensor;
  Random random(1);
  for (const double turn : {0.14, M_PI}) {
    MovementAgreement agreement;
    for (int i = 0; i < 40; ++i) {
      const double length = random.uniform(0.15, 0.4);
      const auto along = [&](double angle) { return seenAs(length * std::cos(angle), length * std::sin(angle), 0); };
      agreement.compare(i, i + 1, {along(0.01 * random.normal()), along(turn + 0.01 * random.normal()), along(0.01 * random.normal())});
    }
    for (const auto& [a, b, expected] : {std::tuple(kCamera, kLidar, turn), {kLidar, kCamera, -turn}, {kCamera, kWheels, turn},
                                         {kWheels, kCamera, -turn}, {kLidar, kWheels, 0.0}, {kWheels, kLidar, 0.0}}) {
      const auto found = agreement.turned(a, b);
      ASSERT_TRUE(found) << toString(a) << ' ' << toString(b);
      EXPECT_NEAR(wrapAngle(found->rad - expected), 0, 0.01) << toString(a) << ' ' << toString(b);
      EXPECT_NEAR(found->sigma_rad, 1.253 * 0.01 * std::sqrt(2) / std::sqrt(40), 1e-3);
    }
  }
}

TEST(MovementAgreement, TurnsAndShortWaysSayNothingOfAngles) {
  MovementAgreement agreement;
  for (int i = 0; i < 40; ++i) {
    agreement.compare(i, i + 0.4, {seenAs(0.3, 0, 0.3), seenAs(0, 0.3, 0.3), seenAs(0.3, 0, 0.3)});
    agreement.compare(i + 0.4, i + 0.8, {seenAs(0.05, 0, 0), seenAs(0, 0.05, 0), seenAs(0.05, 0, 0)});
    if (i < 19) agreement.compare(i + 0.8, i + 1, {seenAs(0.3, 0, 0), seenAs(0, 0.3, 0), std::nullopt});
  }
  EXPECT_FALSE(agreement.turned(MotionSensor::kCamera, MotionSensor::kLidar));
}

}  // namespace
}  // namespace roomgraph::test
