// SPDX-License-Identifier: BSD-3-Clause
// SteadyMotion against the closed form of a Kalman filter and against Monte Carlo.
#include "steady_motion.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

namespace roomgraph {
namespace {

constexpr double kStep_s = 0.1;

Eigen::Matrix2d known(double sigma_m) { return Eigen::Matrix2d::Identity() / (sigma_m * sigma_m); }

TEST(SteadyMotion, GoesOnAsItWent) {
  SteadyMotion motion;
  EXPECT_EQ(motion.step(kStep_s).x, 0) << "at rest at first";
  motion.observe({0.05, -0.01, 0.02}, known(0.001), kStep_s);
  const Pose2 step = motion.step(0.2);
  EXPECT_NEAR(step.x, 0.1, 1e-12);
  EXPECT_NEAR(step.y, -0.02, 1e-12);
  EXPECT_NEAR(step.yaw, 0.04, 1e-12);
}

TEST(SteadyMotion, IsLessSureTheLongerNothingTellsOfAStep) {
  SteadyMotion motion;
  motion.observe({0.05, 0, 0}, known(0.002), kStep_s);
  double before = motion.stepInformation(kStep_s)(0, 0);
  EXPECT_LT(motion.stepInformation(2 * kStep_s)(0, 0), before / 4) << "distance grows with time, and so does doubt of velocity";
  for (int i = 0; i < 5; ++i) {
    motion.observe(motion.step(kStep_s), Eigen::Matrix2d::Zero(), kStep_s);
    const double now = motion.stepInformation(kStep_s)(0, 0);
    EXPECT_LT(now, before);
    before = now;
  }
}

// A wall along x tells of y alone.
TEST(SteadyMotion, LearnsOnlyAlongWhatIsTold) {
  SteadyMotion motion;
  const Eigen::Matrix2d before = motion.stepInformation(kStep_s);
  Eigen::Matrix2d wall = Eigen::Matrix2d::Zero();
  wall(1, 1) = 1e6;
  motion.observe({0, 0, 0}, wall, kStep_s);
  const Eigen::Matrix2d after = motion.stepInformation(kStep_s);
  EXPECT_LT(after(0, 0), before(0, 0));
  EXPECT_GT(after(1, 1), 10 * before(1, 1));
  EXPECT_NEAR(after(0, 1), 0, 1e-9);
}

// One direction: velocities of random walks, observed with noise, fused with the prediction as a match does it.
TEST(SteadyMotion, ErrorsOfItsStepsAreWhatItSays) {
  std::mt19937 random(7);
  std::normal_distribution<double> unit;
  constexpr double kNoise_m = 0.02;
  double squares = 0;
  int count = 0;
  for (int run = 0; run < 200; ++run) {
    SteadyMotion motion;
    double velocity = 0.5 * unit(random);
    for (int i = 0; i < 30; ++i) {
      velocity += std::sqrt(0.2 * kStep_s) * unit(random);  // the variance per second that is assumed of robots
      const double truth = velocity * kStep_s, predicted = motion.step(kStep_s).x;
      const double prior = motion.stepInformation(kStep_s)(0, 0), told = 1 / (kNoise_m * kNoise_m);
      squares += (truth - predicted) * (truth - predicted) * prior;
      ++count;
      const double measured = truth + kNoise_m * unit(random);
      motion.observe({(prior * predicted + told * measured) / (prior + told), 0, 0}, known(kNoise_m), kStep_s);
    }
  }
  EXPECT_NEAR(squares / count, 1, 0.06);
}

}  // namespace
}  // namespace roomgraph
