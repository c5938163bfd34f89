// SPDX-License-Identifier: BSD-3-Clause
// Errors of wheels that are learnt: those put in, with honest deviations, whatever slips there are.
#include "roomgraph/estimation/wheel_calibration.h"

#include <gtest/gtest.h>

#include <cmath>

#include "roomgraph/core/random.h"

namespace roomgraph::test {
namespace {

const WheelErrors kErrors{.length = -0.03, .turn = 0.025, .turn_per_m = 0.008};

// What wheels report of a movement, their systematic errors only.
Pose2 measured(const Pose2& truth) {
  const double length = std::copysign(std::hypot(truth.x, truth.y), truth.x);
  return {truth.x * (1 + kErrors.length), truth.y * (1 + kErrors.length), truth.yaw * (1 + kErrors.turn) + kErrors.turn_per_m * length};
}

Movement seen(const Pose2& moved, double sigma_m, double sigma_rad) {
  Vector6d sigma;
  sigma << sigma_m, sigma_m, 0.5, 0.5, 0.5, sigma_rad;
  return {toPose3(moved), Matrix6d(sigma.cwiseAbs2().asDiagonal())};
}

Pose2 drawnMovement(Random& random) {
  const double forward = random.uniform(-0.1, 0.4), turn = random.uniform(-0.5, 0.5);
  return {forward * std::cos(turn / 2), forward * std::sin(turn / 2), turn};
}

void expectErrors(const WheelErrors& found, const WheelErrors& truth, double within) {
  EXPECT_NEAR(found.length, truth.length, within);
  EXPECT_NEAR(found.turn, truth.turn, within);
  EXPECT_NEAR(found.turn_per_m, truth.turn_per_m, within);
}

TEST(WheelCalibration, KnowsNothingAtFirst) {
  const WheelCalibration calibration;
  expectErrors(calibration.errors(), {}, 0);
  EXPECT_EQ(calibration.compared(), 0);
}

TEST(WheelCalibration, FindsTheErrors) {
  WheelCalibration calibration;
  Random random(1);
  for (int i = 0; i < 3000; ++i) {
    const Pose2 truth = drawnMovement(random);
    calibration.compare(measured(truth), seen(truth, 1e-3, 1e-3));
  }
  EXPECT_GT(calibration.compared(), 2500);
  expectErrors(calibration.errors(), kErrors, 1e-3);
}

TEST(WheelCalibration, ASlipIsOutweighed) {
  WheelCalibration calibration;
  Random random(2);
  for (int i = 0; i < 300; ++i) {
    const Pose2 truth = drawnMovement(random);
    Pose2 wheels = measured(truth);
    if (i % 20 == 10) wheels.x += 0.4, wheels.yaw += 0.3;
    calibration.compare(wheels, seen(truth, 1e-3, 1e-3));
  }
  expectErrors(calibration.errors(), kErrors, 5e-3);
}

// Normalised squared errors over many robots: 1 is expected of each.
TEST(WheelCalibration, DeviationsAreWhatTheErrorsAre) {
  Random random(3);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  constexpr int kRobots = 300;
  for (int robot = 0; robot < kRobots; ++robot) {
    WheelCalibration calibration;
    for (int i = 0; i < 100; ++i) {
      const Pose2 truth = drawnMovement(random);
      Pose2 wheels = measured(truth);
      const double length = std::hypot(truth.x, truth.y);
      const double gain = 1 + 0.03 * random.normal() / std::sqrt(length);
      wheels.x *= gain;
      wheels.y *= gain;
      wheels.yaw += std::hypot(0.03 * std::sqrt(std::abs(truth.yaw)), 0.01 * std::sqrt(length)) * random.normal();
      const Pose2 noisy{truth.x + 0.002 * random.normal(), truth.y + 0.002 * random.normal(), truth.yaw + 0.002 * random.normal()};
      calibration.compare(wheels, seen(noisy, 0.002, 0.002));
    }
    const auto [length, turn, turn_per_m] = calibration.errors();
    const Eigen::Vector3d off(length - kErrors.length, turn - kErrors.turn, turn_per_m - kErrors.turn_per_m);
    sum += off.cwiseQuotient(calibration.standardDeviations()).cwiseAbs2();
  }
  for (const double mean : sum / kRobots) {
    EXPECT_GT(mean, 0.6);
    EXPECT_LT(mean, 1.4);
  }
}

// Where wheels stand what is seen is noise, which has a length.
TEST(WheelCalibration, HoursOfRestSayNothing) {
  WheelCalibration calibration;
  Random random(4);
  for (int i = 0; i < 20000; ++i) calibration.compare({}, seen({0.003 * random.normal(), 0.003 * random.normal(), 0.003 * random.normal()}, 0.002, 0.002));
  expectErrors(calibration.errors(), {}, 0);
  EXPECT_EQ(calibration.compared(), 0);
}

// A lidar 5 cm from where it is said to be moves by itself when the robot turns on the spot.
TEST(WheelCalibration, TurnsOnTheSpotSayNothingOfLengthsWhereverTheSensorSits) {
  WheelCalibration calibration;
  const Pose2 wrong_by{0.05, 0.03, 0};
  for (int i = 0; i < 300; ++i) {
    const Pose2 spot{0, 0, i % 2 ? 0.26 : -0.26}, ahead{0.26, 0, 0};
    for (const Pose2& truth : {spot, spot, ahead}) calibration.compare(truth, seen(wrong_by * truth * wrong_by.inverse(), 1e-3, 1e-3));
  }
  expectErrors(calibration.errors(), {}, 1e-3);
}

TEST(WheelCalibration, RobotsThatDriveBackwardsErrAlike) {
  WheelCalibration calibration;
  Random random(5);
  for (int i = 0; i < 1000; ++i) {
    const double turn = random.uniform(-0.3, 0.3);
    const Pose2 truth{-0.3 * std::cos(turn / 2), -0.3 * std::sin(turn / 2), turn};
    calibration.compare(measured(truth), seen(truth, 1e-3, 1e-3));
  }
  expectErrors(calibration.errors(), kErrors, 1e-3);
}

TEST(WheelCalibration, AMovementWithoutLengthSaysNothingOfLengths) {
  WheelCalibration calibration;
  const double before = calibration.standardDeviations()[0];
  for (int i = 0; i < 100; ++i) calibration.compare({0, 0, 0.3}, seen({0, 0, 0.31}, 1e-3, 1e-3));
  EXPECT_EQ(calibration.standardDeviations()[0], before);
  EXPECT_NEAR(calibration.errors().turn, -0.01 / 0.31, 5e-3);
}

}  // namespace
}  // namespace roomgraph::test
