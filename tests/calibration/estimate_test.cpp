// SPDX-License-Identifier: BSD-3-Clause
// Estimation of a calibration from made-up drives whose truth is known.
#include <gmock/gmock.h>

#include <map>

#include "estimate_calibration.h"
#include "made_up_drive.h"
#include "roomgraph/core/errors.h"

namespace roomgraph::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

DriveNoise usualNoise() {
  return {.lidar_m = 0.003,
          .lidar_rad = 0.001,
          .range_m = 0.015,
          .depth_per_m2 = 0.0015,
          .wheels_m = 0.01,
          .wheels_rad = 0.02,
          .step_rad = 0.002,
          .step_m = 0.004,
          .board_rad = 0.004,
          .board_m = 0.002};
}

double tolerance(int parameter) {
  return parameterTraits()[static_cast<std::size_t>(parameter)].unknown_from;
}

bool is(const CalibrationEstimate& estimate, int parameter, Knowledge knowledge) {
  return estimate.knowledge[static_cast<std::size_t>(parameter)] == knowledge;
}

TEST(EstimateCalibration, FindsTheTruthInExactData) {
  MadeUpDrive drive({});
  const auto estimate = estimateCalibration(drive.task());
  const ParameterVector truth = trueParameters();
  for (int i = 0; i < kParameterCount; ++i) {
    EXPECT_TRUE(is(estimate, i, Knowledge::kFixed)) << parameterTraits()[static_cast<std::size_t>(i)].name;
    EXPECT_NEAR(estimate.after[i], truth[i], 0.05 * tolerance(i))
        << parameterTraits()[static_cast<std::size_t>(i)].name;
  }
}

// Twice the data: standard deviations fall, at best to 1 / sqrt(2) of those of one drive.
TEST(EstimateCalibration, TwoDrivesSayMoreThanOne) {
  MadeUpDrive first({.seconds = 40, .noise = usualNoise(), .seed = 21});
  MadeUpDrive second({.seconds = 40, .noise = usualNoise(), .seed = 22});
  CalibrationTask both = first.task();
  for (const RecordingEvidence& evidence : second.task().evidence) both.evidence.push_back(evidence);
  const auto alone = estimateCalibration(first.task()), together = estimateCalibration(both);
  const ParameterVector truth = trueParameters();
  double ratio = 0;
  for (int i = 0; i < kParameterCount; ++i) {
    ratio += together.sigma(i) / alone.sigma(i) / static_cast<double>(kParameterCount);
    EXPECT_LT(std::abs(together.after[i] - truth[i]), 5 * together.sigma(i) + 1e-9)
        << parameterTraits()[static_cast<std::size_t>(i)].name;
  }
  EXPECT_LT(ratio, 0.95);
  EXPECT_GT(ratio, 0.6);
}

TEST(EstimateCalibration, ErrorsAreWhatTheCovarianceSays) {
  constexpr int kSeeds = 8;
  const ParameterVector truth = trueParameters();
  ParameterVector squares = ParameterVector::Zero();
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    MadeUpDrive drive({.seconds = 60, .noise = usualNoise(), .seed = seed});
    const auto estimate = estimateCalibration(drive.task());
    for (int i = 0; i < kParameterCount; ++i) {
      const double off = estimate.after[i] - truth[i];
      squares[i] += off * off / estimate.covariance(i, i) / kSeeds;
      EXPECT_LT(std::abs(off), 5 * estimate.sigma(i) + 1e-9)
          << parameterTraits()[static_cast<std::size_t>(i)].name;
    }
    EXPECT_LT((estimate.after - truth).segment<2>(kLidarX).norm(), 0.006) << seed;
    EXPECT_LT((estimate.after - truth).segment<3>(kCameraX).norm(), 0.008) << seed;
    EXPECT_LT((estimate.after - truth).segment<3>(kCameraYaw).norm(), 0.3 * kDegree) << seed;
    EXPECT_NEAR(estimate.after[kCameraTime], truth[kCameraTime], 0.003) << seed;
  }
  for (int i = 0; i < kParameterCount; ++i) {
    // The mean of eight chi squares is below 3.3 in 999 of 1000 cases. The covariance is on the safe side
    // where errors of neighbouring measurements cancel, so that the lower bound is loose.
    EXPECT_GT(squares[i], 0.1) << parameterTraits()[static_cast<std::size_t>(i)].name;
    EXPECT_LT(squares[i], 3.3) << parameterTraits()[static_cast<std::size_t>(i)].name;
  }
}

// Without walls in view nothing but the drive's own length tells the unit of depth: it must not shrink to make noise small.
TEST(EstimateCalibration, WithoutWallsDepthDoesNotShrink) {
  MadeUpDrive drive({.seconds = 60, .noise = usualNoise()});
  CalibrationTask task = drive.task();
  for (auto& view : task.evidence[0].views) view.upright.clear();
  const auto estimate = estimateCalibration(task);
  EXPECT_NEAR(estimate.after[kDepthScale], trueParameters()[kDepthScale], 0.05);
  EXPECT_NEAR(estimate.after[kCameraZ], trueParameters()[kCameraZ], 0.03);
}

// The solver's derivatives lack the columns of what is held.
TEST(EstimateCalibration, ErrorsAreWhatTheCovarianceSaysWithoutWheels) {
  constexpr int kSeeds = 4;
  ParameterVector squares = ParameterVector::Zero();
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    MadeUpDrive drive({.seconds = 60, .wheels = false, .noise = usualNoise(), .seed = seed});
    ParameterVector before = wrongParameters();
    before.segment<3>(kLidarX) = trueParameters().segment<3>(kLidarX);
    CalibrationTask task = drive.task(before);
    for (const int i : {kLidarX, kLidarY, kLidarYaw, kWheelTime, kWheelScale, kTurnScale, kHeadingDrift})
      task.held.set(static_cast<std::size_t>(i));
    const auto estimate = estimateCalibration(task);
    for (int i = kCameraX; i <= kCameraRoll; ++i) {
      const double off = estimate.after[i] - trueParameters()[i];
      EXPECT_LT(std::abs(off), 5 * estimate.sigma(i)) << parameterTraits()[static_cast<std::size_t>(i)].name;
      squares[i] += off * off / estimate.covariance(i, i) / kSeeds;
    }
  }
  EXPECT_GT(squares.segment<6>(kCameraX).mean(), 0.1) << "not many times too large";
  EXPECT_LT(squares.segment<6>(kCameraX).mean(), 3.3);
}

// Neither lidar nor camera has a place along y on the robot then, but both have one to each other.
TEST(EstimateCalibration, WhatOnlyTogetherIsKnownStaysKnown) {
  MadeUpDrive drive({.seconds = 20, .turns = false, .wheels = false, .noise = usualNoise(), .seed = 2});
  CalibrationTask task = drive.task();
  for (const int i : {kWheelTime, kWheelScale, kTurnScale, kHeadingDrift}) task.held.set(static_cast<std::size_t>(i));
  const auto estimate = estimateCalibration(task);
  const auto yawInLidar = [](const ParameterVector& p) { return wrapAngle(p[kCameraYaw] - p[kLidarYaw]); };
  EXPECT_NEAR(yawInLidar(estimate.after), yawInLidar(trueParameters()), 0.3 * kDegree);
}

TEST(EstimateCalibration, WithoutTurnsPlacesStayAsTheyWere) {
  MadeUpDrive drive({.seconds = 20, .turns = false, .noise = usualNoise()});
  const auto task = drive.task();
  const auto estimate = estimateCalibration(task);
  for (const int i : {kLidarX, kTurnScale, kWheelTime})
    EXPECT_FALSE(is(estimate, i, Knowledge::kFixed)) << parameterTraits()[static_cast<std::size_t>(i)].name;
  EXPECT_TRUE(is(estimate, kTurnScale, Knowledge::kUnfixed));
  EXPECT_EQ(estimate.after[kTurnScale], task.before[kTurnScale]);
  EXPECT_THAT(estimate.unfixed, Contains(HasSubstr("wheel turn scale")));
  // Straight ahead shows where ahead is, and the floor is seen all the same.
  EXPECT_TRUE(is(estimate, kLidarYaw, Knowledge::kFixed));
  EXPECT_NEAR(estimate.after[kLidarYaw], trueParameters()[kLidarYaw], 4 * estimate.sigma(kLidarYaw));
  EXPECT_NEAR(estimate.after[kCameraPitch], trueParameters()[kCameraPitch], 0.3 * kDegree);
}

TEST(EstimateCalibration, WithoutCameraWheelsAndLidarAreCalibrated) {
  MadeUpDrive drive({.views = false, .steps = false});
  auto task = drive.task();
  for (int i = kCameraX; i <= kCameraTime; ++i) task.held.set(static_cast<std::size_t>(i));
  task.held.set(kDepthScale);
  task.held.set(kDepthBias);
  const auto estimate = estimateCalibration(task);
  EXPECT_TRUE(is(estimate, kCameraX, Knowledge::kHeld));
  EXPECT_EQ(estimate.after[kCameraX], task.before[kCameraX]);
  for (const int i : {kLidarX, kLidarY, kLidarYaw, kWheelTime, kWheelScale, kTurnScale, kHeadingDrift})
    EXPECT_NEAR(estimate.after[i], trueParameters()[i], 0.05 * tolerance(i)) << i;
}

TEST(EstimateCalibration, TheFloorAloneGivesHeightPitchAndRoll) {
  ParameterVector truth = trueParameters();
  truth[kDepthScale] = 1;
  MadeUpDrive drive({.lidar = false, .wheels = false, .steps = false}, truth);
  auto task = drive.task();
  task.held.set();
  for (const int i : {kCameraZ, kCameraPitch, kCameraRoll, kDepthBias})
    task.held.reset(static_cast<std::size_t>(i));
  // Which way the camera looks is not told by the floor; pitch and roll are those of its recorded direction.
  task.before[kCameraYaw] = truth[kCameraYaw];
  const auto estimate = estimateCalibration(task);
  for (const int i : {kCameraZ, kCameraPitch, kCameraRoll})
    EXPECT_NEAR(estimate.after[i], truth[i], 0.05 * tolerance(i))
        << parameterTraits()[static_cast<std::size_t>(i)].name;
  EXPECT_EQ(estimate.after[kCameraX], task.before[kCameraX]);
}

// Without walls, floor or visual odometry: where the camera sits but for its height, and depth, which is measured against the
// board's known size.
TEST(EstimateCalibration, ABoardAloneFixesAllButTheHeight) {
  MadeUpDrive drive({.seconds = 60, .views = false, .steps = false, .board = true});
  auto task = drive.task();
  task.evidence[0].scans.clear();
  const ParameterVector truth = trueParameters();
  const auto estimate = estimateCalibration(task);
  EXPECT_GT(estimate.measurements.at("pairs of views of the board"), 10);
  EXPECT_GT(estimate.measurements.at("depths of the board"), 10);
  for (const int i :
       {kCameraX, kCameraY, kCameraYaw, kCameraPitch, kCameraRoll, kCameraTime, kDepthScale, kDepthBias}) {
    EXPECT_TRUE(is(estimate, i, Knowledge::kFixed)) << parameterTraits()[static_cast<std::size_t>(i)].name;
    EXPECT_NEAR(estimate.after[i], truth[i], 0.05 * tolerance(i))
        << parameterTraits()[static_cast<std::size_t>(i)].name;
  }
  EXPECT_TRUE(is(estimate, kCameraZ, Knowledge::kUnfixed)) << "a board moves alike seen from any height";
  EXPECT_EQ(estimate.after[kCameraZ], task.before[kCameraZ]);
}

TEST(EstimateCalibration, ErrorsWithABoardAreWhatTheCovarianceSays) {
  constexpr int kSeeds = 8;
  const ParameterVector truth = trueParameters();
  const std::vector<int> of_camera{kCameraX, kCameraY, kCameraZ, kCameraYaw, kCameraPitch, kCameraRoll, kDepthScale, kDepthBias};
  ParameterVector squares = ParameterVector::Zero();
  double ratio = 0;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    MadeUpDrive with({.seconds = 40, .board = true, .noise = usualNoise(), .seed = seed});
    MadeUpDrive without({.seconds = 40, .noise = usualNoise(), .seed = seed});
    const auto estimate = estimateCalibration(with.task());
    for (const int i : of_camera) {
      const double off = estimate.after[i] - truth[i];
      squares[i] += off * off / estimate.covariance(i, i) / kSeeds;
    }
    ratio += estimate.sigma(kDepthBias) / estimateCalibration(without.task()).sigma(kDepthBias) / kSeeds;
  }
  for (const int i : of_camera) {  // limits as above
    EXPECT_GT(squares[i], 0.1) << parameterTraits()[static_cast<std::size_t>(i)].name;
    EXPECT_LT(squares[i], 3.3) << parameterTraits()[static_cast<std::size_t>(i)].name;
  }
  EXPECT_LT(ratio, 0.95) << "a board is worth something besides walls and floor";
}

// Thirty views of a board, and neither walls nor floor: few to tell errors by.
TEST(EstimateCalibration, ErrorsWithABoardAloneAreWhatTheCovarianceSays) {
  constexpr int kSeeds = 40;
  const ParameterVector truth = trueParameters();
  std::map<int, double> squares, told;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    MadeUpDrive drive({.seconds = 60, .views = false, .steps = false, .board = true, .noise = usualNoise(), .seed = seed});
    CalibrationTask task = drive.task();
    task.evidence[0].scans.clear();
    const auto estimate = estimateCalibration(task);
    for (const int i : {kCameraX, kCameraY, kCameraYaw}) {
      const double off = estimate.after[i] - truth[i];
      squares[i] += off * off / kSeeds;
      told[i] += estimate.covariance(i, i) / kSeeds;
    }
  }
  for (const auto& [i, square] : squares) {
    EXPECT_GT(square, 0.2 * told[i]) << parameterTraits()[static_cast<std::size_t>(i)].name;
    EXPECT_LT(square, 1.6 * told[i]) << parameterTraits()[static_cast<std::size_t>(i)].name;
  }
}

TEST(EstimateCalibration, NothingSaysNothing) {
  CalibrationTask task;
  task.evidence.emplace_back();
  EXPECT_THROW(estimateCalibration(task), RunError);
}

}  // namespace
}  // namespace roomgraph::test
