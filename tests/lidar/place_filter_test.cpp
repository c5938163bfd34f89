// SPDX-License-Identifier: BSD-3-Clause
// PlaceFilter against batch least squares and against Monte Carlo.
#include "place_filter.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <random>
#include <vector>

namespace roomgraph {
namespace {

constexpr double kStep_s = 0.1, kMap_per_m2 = 100;  // what the map in view tells, whatever the scans: .1 m

Eigen::Matrix2d known(double sigma_m) { return Eigen::Matrix2d::Identity() / (sigma_m * sigma_m); }

// A place along x as a match finds it: from the prediction and what the scan says of the true place.
struct Match {
  double place = 0;  ///< found
  double error = 0, variance = 0;  ///< of the prediction, and what it was said to be
};

Match matched(PlaceFilter& filter, double from, double truth, const std::optional<Pose2>& measured, double noise, double sigma_m) {
  const Pose2 step = measured ? filter.corrected(*measured) : filter.steadyStep(kStep_s);
  filter.predict(measured, kStep_s, 0);
  Match out{0, from + step.x - truth, filter.covariance()(0, 0)};
  const double prior = 1 / out.variance, scan = 1 / (sigma_m * sigma_m);
  out.place = (prior * (from + step.x) + scan * (truth + noise)) / (prior + scan);
  filter.update({out.place - from, 0, 0}, known(sigma_m));
  return out;
}

TEST(PlaceFilter, GoesOnAsItWent) {
  PlaceFilter filter;
  EXPECT_EQ(filter.steadyStep(kStep_s).x, 0) << "at rest at first";
  filter.predict(std::nullopt, kStep_s, 0);
  filter.update({0.05, -0.01, 0.02}, known(1e-6));
  const Pose2 step = filter.steadyStep(0.2);
  EXPECT_NEAR(step.x, 0.1, 1e-4);
  EXPECT_NEAR(step.y, -0.02, 1e-4);
  EXPECT_NEAR(step.yaw, 0.04, 1e-12);
}

TEST(PlaceFilter, IsLessSureTheLongerNothingTellsOfThePlace) {
  PlaceFilter filter;
  for (int i = 0; i < 20; ++i) {
    filter.predict(std::nullopt, kStep_s, 0);
    filter.update({0.05, 0, 0}, known(0.002));
  }
  double before = filter.covariance()(0, 0);
  for (int i = 0; i < 5; ++i) {
    filter.predict(std::nullopt, kStep_s, 0);
    EXPECT_GT(filter.covariance()(0, 0), before);
    before = filter.covariance()(0, 0);
    filter.update(filter.steadyStep(kStep_s), Eigen::Matrix2d::Zero());
    EXPECT_LT(filter.covariance()(0, 0), 1 / kMap_per_m2);
  }
}

// A wall along x tells of y alone, whatever the yaw in which the steps are told.
TEST(PlaceFilter, LearnsOnlyAlongWhatIsTold) {
  constexpr double kYaw = 0.5;
  Eigen::Matrix2d wall = Eigen::Matrix2d::Zero();
  wall(1, 1) = 1e6;
  for (const bool measures : {false, true}) {
    const std::optional<Pose2> measured = measures ? std::optional<Pose2>({0.1, 0.02, 0}) : std::nullopt;
    PlaceFilter filter;
    for (int i = 0; i < 10; ++i) {
      filter.predict(measured, kStep_s, kYaw);
      const double along = filter.covariance()(0, 0), across = filter.covariance()(1, 1);
      const Pose2 step = measures ? filter.corrected(*measured) : filter.steadyStep(kStep_s);
      filter.update(step, wall);
      EXPECT_GT(filter.covariance()(0, 0), 0.5 * std::min(along, 1 / kMap_per_m2)) << i;
      EXPECT_LT(filter.covariance()(1, 1), std::min(across, 1.01e-6)) << i;
    }
  }
}

// The place and the scale of all steps together, by least squares over all that was measured.
TEST(PlaceFilter, IsTheLeastSquaresEstimateOfPlacesAndScale) {
  constexpr int kSteps = 12;
  constexpr double kMeasured_m = 0.1, kScan_m = 0.01;
  const double step_m2 = 0.005 * 0.005 + 0.03 * 0.03 * kMeasured_m;
  std::mt19937 random(3);
  std::normal_distribution<double> unit;
  PlaceFilter filter;
  double place = 0;
  // Unknowns: the places after the first, and the share that is missing.
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(kSteps + 1, kSteps + 1);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(kSteps + 1);
  const auto add = [&](const std::vector<std::pair<int, double>>& design, double value, double variance) {
    for (const auto& [i, a] : design) {
      right[i] += a * value / variance;
      for (const auto& [j, b] : design) information(i, j) += a * b / variance;
    }
  };
  add({{kSteps, 1}}, 0, 0.04 * 0.04);
  for (int i = 0; i < kSteps; ++i) {
    const Pose2 measured{kMeasured_m, 0, 0};
    const double said = 0.105 * (i + 1) + kScan_m * unit(random);
    const Pose2 step = filter.corrected(measured);
    filter.predict(measured, kStep_s, 0);
    const double prior = 1 / filter.covariance()(0, 0), scan = 1 / (kScan_m * kScan_m);
    const double found = (prior * (place + step.x) + scan * said) / (prior + scan);
    filter.update({found - place, 0, 0}, known(kScan_m));
    place = found;
    if (i > 0)
      add({{i, 1}, {i - 1, -1}, {kSteps, -kMeasured_m}}, kMeasured_m, step_m2);
    else
      add({{i, 1}, {kSteps, -kMeasured_m}}, kMeasured_m, step_m2);
    add({{i, 1}}, said, kScan_m * kScan_m);
  }
  const Eigen::VectorXd solved = information.ldlt().solve(right);
  const Eigen::MatrixXd covariance = information.inverse();
  EXPECT_NEAR(place, solved[kSteps - 1], 2e-4);
  EXPECT_NEAR(filter.corrected({1, 0, 0}).x - 1, solved[kSteps], 2e-3);
  // The filter's bound of .1 m makes its places a little surer.
  EXPECT_NEAR(filter.covariance()(0, 0), covariance(kSteps - 1, kSteps - 1), 0.02 * covariance(kSteps - 1, kSteps - 1));
}

// Velocities of random walks, and wheels of a wrong scale: errors of predictions are what their variances say.
TEST(PlaceFilter, ErrorsOfItsPredictionsAreWhatItSays) {
  std::mt19937 random(7);
  std::normal_distribution<double> unit;
  constexpr double kNoise_m = 0.02;
  for (const bool measures : {false, true}) {
    double squares = 0;
    int count = 0;
    for (int run = 0; run < 400; ++run) {
      PlaceFilter filter;
      const double scale = 1 + 0.04 * unit(random);
      double velocity = 0.7 + 0.5 * unit(random), truth = 0, place = 0;
      for (int i = 0; i < 30; ++i) {
        velocity += std::sqrt(0.2 * kStep_s) * unit(random);  // the variance per second that is assumed of robots
        double moved = velocity * kStep_s + 0.001 * unit(random);
        std::optional<Pose2> measured;
        if (measures) {
          measured = Pose2{0.1, 0, 0};
          moved = 0.1 * scale + std::sqrt(0.005 * 0.005 + 0.03 * 0.03 * 0.1) * unit(random);
        }
        truth += moved;
        const Match match = matched(filter, place, truth, measured, kNoise_m * unit(random), kNoise_m);
        place = match.place;
        if (i < 5) continue;
        squares += match.error * match.error / match.variance;
        ++count;
      }
    }
    EXPECT_NEAR(squares / count, 1, 0.06) << measures;
  }
}

TEST(PlaceFilter, LearnsLittleFromASlip) {
  const auto missing = [](double trust) {
    PlaceFilter filter;
    for (int i = 0; i < 10; ++i) {
      filter.predict(Pose2{0.1, 0, 0}, kStep_s, 0);
      filter.update(filter.corrected({0.1, 0, 0}), known(0.01));
    }
    filter.predict(Pose2{0.1, 0, 0}, kStep_s, 0);
    filter.update({0.02, 0, 0}, known(0.01), trust);
    return filter.corrected({1, 0, 0}).x - 1;
  };
  EXPECT_LT(missing(1), -0.02);
  EXPECT_LT(std::abs(missing(1e-3)), 0.05 * std::abs(missing(1)));
}

// Robots whose wheels are silent for once go on as they went, which was known; scale and velocity do not mix.
TEST(PlaceFilter, WheelsThatFallSilentLeaveAVelocity) {
  PlaceFilter filter, fresh;
  for (int i = 0; i < 10; ++i) {
    filter.predict(Pose2{0.05, 0, 0.01}, kStep_s, 0);
    filter.update({0.052, 0, 0.01}, known(0.003));
  }
  const double scale = filter.corrected({1, 0, 0}).x;
  EXPECT_NEAR(filter.steadyStep(kStep_s).x, 0.052, 1e-9);
  filter.predict(std::nullopt, kStep_s, 0);
  fresh.predict(std::nullopt, kStep_s, 0);
  EXPECT_LT(filter.covariance()(0, 0), fresh.covariance()(0, 0) / 4);
  filter.update({0.04, 0, 0.01}, known(0.003));
  EXPECT_EQ(filter.corrected({1, 0, 0}).x, scale);
}

}  // namespace
}  // namespace roomgraph
