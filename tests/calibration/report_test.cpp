// SPDX-License-Identifier: BSD-3-Clause
// Matching of walls by a wrong calibration, and the calibration as text.
#include <gmock/gmock.h>

#include <fstream>
#include <set>

#include "coarse_offsets.h"
#include "made_up_drive.h"
#include "roomgraph/calibration/calibrate.h"
#include "sensor_costs.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

double offOf(const RecordingEvidence& evidence, const WallMatch& match, const ParameterVector& p) {
  double off = 0;
  WallCost{&evidence.lidar[match.path], match, 1}(p.data(), &off);
  return std::abs(off);
}

// The wrong calibration must lead to the right pairs: by the true one they lie on each other.
TEST(WallMatches, AreRightThoughTheCalibrationIsWrong) {
  MadeUpDrive drive({.seconds = 15, .noise = {.range_m = 0.01, .depth_per_m2 = 0.001}});
  const auto evidence = drive.evidence();
  ParameterVector wrong = wrongParameters();
  wrong[kCameraTime] = trueParameters()[kCameraTime];
  const auto matches = matchWalls(evidence, wrong, MadeUpDrive::kLidarZ, {0.35, 0.35});
  ASSERT_GT(matches.size(), 40u);
  int right = 0;
  for (const auto& match : matches) right += offOf(evidence, match, trueParameters()) < 0.06;
  EXPECT_GT(right, 0.95 * static_cast<double>(matches.size()));
}

TEST(WallMatches, KeepToTheGateAndToTheHeightOfTheLidar) {
  MadeUpDrive drive({.seconds = 10});
  const auto evidence = drive.evidence();
  ParameterVector off = trueParameters();
  off[kCameraX] += 0.3;
  const auto strict = matchWalls(evidence, off, MadeUpDrive::kLidarZ, {0.02, 0.2});
  const auto loose = matchWalls(evidence, off, MadeUpDrive::kLidarZ, {0.4, 0.2});
  EXPECT_LT(strict.size(), 0.5 * static_cast<double>(loose.size()));
  EXPECT_TRUE(matchWalls(evidence, trueParameters(), 5, {}).empty()) << "a lidar far above";
  EXPECT_TRUE(matchWalls({}, off, 0.3, {}).empty());
}

TEST(CoarseOffsets, AreNearTheTruth) {
  MadeUpDrive drive({});
  const auto task = drive.task();
  ParameterVector values = task.before;
  addCoarseOffsets(task, values);
  EXPECT_NEAR(values[kCameraTime], trueParameters()[kCameraTime], 0.01);
  EXPECT_NEAR(values[kWheelTime], trueParameters()[kWheelTime], 0.01);
  auto held = task;
  held.held.set(kCameraTime);
  values = task.before;
  addCoarseOffsets(held, values);
  EXPECT_EQ(values[kCameraTime], task.before[kCameraTime]);
}

class CalibrationText : public ::testing::Test {
 protected:
  CalibrationText() {
    report.sensors = {"KINECT", "LASER", Pose3::Identity(), Pose3::Identity(), Pose3::Identity(), true, true};
    report.frame = "the robot's frame is that of the wheels";
    report.estimate.knowledge.fill(Knowledge::kFixed);
    report.estimate.covariance = 1e-6 * ParameterMatrix::Identity();
    report.calibration.poses = {{"KINECT", poseFromYpr(0.0812, -0.0123, 0.9, 0.01, 0.2, -0.003)},
                                {"LASER", poseFromYpr(0.2, 0, 0.3, -0.05, 0, 0)}};
    report.calibration.corrections = {
        {{"KINECT", -0.0312}}, 0.0211, {1.021, 0.983, -0.0071}, {1.004, 0.0123}};
  }
  Calibration readBack(const std::string& text) {
    std::ofstream(folder.file("c.ini")) << text;
    return readCalibration(folder.file("c.ini"));
  }
  CalibrationReport report;
  TemporaryFolder folder;
};

TEST_F(CalibrationText, ComesBackAsItWas) {
  const Calibration back = readBack(calibrationText(report));
  for (const auto& [label, pose] : report.calibration.poses)
    EXPECT_TRUE(back.poses.at(label).isApprox(pose, 1e-5));
  EXPECT_NEAR(back.corrections.time_offsets_s.at("KINECT"), -0.0312, 1e-7);
  EXPECT_EQ(back.corrections.time_offsets_s.size(), 1u) << "the lidar's clock is the reference";
  EXPECT_NEAR(back.corrections.wheels_time_offset_s, 0.0211, 1e-7);
  EXPECT_EQ(back.corrections.wheels, report.calibration.corrections.wheels);
  EXPECT_EQ(back.corrections.depth, report.calibration.corrections.depth);
}

TEST_F(CalibrationText, SaysHowSureItIs) {
  report.estimate.knowledge[kLidarX] = Knowledge::kUnfixed;
  report.estimate.knowledge[kCameraYaw] = Knowledge::kPartly;
  const std::string text = calibrationText(report);
  EXPECT_THAT(text, AllOf(HasSubstr("# Frame: the robot's frame is that of the wheels.\n"),
                          HasSubstr("# lidar x (not fixed by this motion: as recorded), lidar y +-0.001 m"),
                          HasSubstr("camera yaw +-0.057 deg (only together with others)")));
}

TEST_F(CalibrationText, IsSilentAboutSensorsThatAreNotThere) {
  report.sensors.wheels = false;
  report.sensors.robot_from_lidar.reset();
  const std::string text = calibrationText(report);
  EXPECT_THAT(text, AllOf(HasSubstr("[sensor KINECT]"), Not(HasSubstr("[wheels]")), Not(HasSubstr("LASER"))));
  readBack(text);
}

TEST(SensorParameters, HaveNamesUnitsAndLimits) {
  std::set<std::string> names;
  for (const auto& traits : parameterTraits()) {
    names.insert(traits.name);
    EXPECT_GT(traits.unknown_from, 0);
  }
  EXPECT_EQ(names.size(), static_cast<std::size_t>(kParameterCount));
  EXPECT_STREQ(parameterTraits()[kDepthBias].name, "depth bias");
  EXPECT_STREQ(parameterTraits()[kCameraYaw].unit, "rad");
}

}  // namespace
}  // namespace roomgraph::test
