// SPDX-License-Identifier: BSD-3-Clause
// Which clocks are set, from where on, and what is said of them.
#include "roomgraph/pipeline/clock_settings.h"

#include <gmock/gmock.h>

#include <cmath>

namespace roomgraph::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

const ClockSetting kLateCamera{MotionSensor::kCamera, "KINECT", {-0.1, 0.003}}, kEarlyWheels{MotionSensor::kWheels, "", {0.25, 0.01}};

TEST(ClockSettings, AddUpBySensorAndSeparatelySinceAJump) {
  ClockSetting jumped = kLateCamera;
  jumped.jumped = true;
  std::vector<ClockSetting> clocks;
  addClocks({kLateCamera}, clocks);
  addClocks({jumped, kEarlyWheels}, clocks);
  addClocks({{MotionSensor::kCamera, "KINECT", {0.02, 0.002}}}, clocks);
  ClockSetting both = kLateCamera;
  both.offset = {-0.1 + 0.02, 0.002};
  EXPECT_THAT(clocks, ElementsAre(both, jumped, kEarlyWheels));
}

TEST(ClockSettings, AreAddedToWhatACalibrationSays) {
  ClockSetting jumped = kLateCamera, wheels_jumped = kEarlyWheels;
  jumped.jumped = wheels_jumped.jumped = true;
  RecordCorrections corrections{.time_offsets_s = {{"KINECT", 0.04}, {"LIDAR", 0.01}}, .wheels_time_offset_s = 0.05};
  addClocks({kLateCamera, kEarlyWheels, jumped, wheels_jumped}, corrections);
  EXPECT_NEAR(corrections.time_offsets_s["KINECT"], -0.06, 1e-12);
  EXPECT_EQ(corrections.time_offsets_s["LIDAR"], 0.01);
  EXPECT_EQ(corrections.wheels_time_offset_s, 0.3);
  EXPECT_EQ(corrections.time_jumps_s["KINECT"], -0.1);
  EXPECT_EQ(corrections.wheels_time_jump_s, 0.25);
}

TEST(ClockSettings, TheStampsSayWhetherAClockJumpedAndByHowMuch) {
  ReadStatistics read;
  read.stamp_jumps = {{"KINECT", {0.9, 0.12}}, {"odometry", {0.25}}};
  const SensorClocks never_agreed;
  const auto clocks = withJumps({kLateCamera, kEarlyWheels, {MotionSensor::kLidar, "LIDAR", {0.12, 0.003}}}, never_agreed, read);
  ASSERT_EQ(clocks.size(), 3u);
  EXPECT_TRUE(clocks[0].jumped);
  EXPECT_EQ(clocks[0].offset, (TimeOffset{-0.12, 0.003}));
  EXPECT_FALSE(clocks[1].jumped) << "that jump went the other way";
  EXPECT_EQ(clocks[1].offset, kEarlyWheels.offset);
  EXPECT_FALSE(clocks[2].jumped);
  EXPECT_TRUE(canBeSet(never_agreed));
}

TEST(ClockSettings, ClocksThatAgreedAndComeApartAreNotSet) {
  Trajectory lidar, wheels;
  double yaw = 0;
  for (int i = 0; i < 1200; ++i) {
    const double t = 0.05 * i, rate = std::sin(0.9 * t) + std::sin(2.3 * t);
    yaw += 0.05 * rate;
    lidar.add(t, toPose3(Pose2{0, 0, yaw}));
    wheels.add(t, toPose3(Pose2{0, 0, yaw}));
  }
  SensorClocks clocks;
  clocks.compare(lidar, {}, wheels);
  ASSERT_TRUE(clocks.agreed());
  EXPECT_FALSE(canBeSet(clocks));
  ReadStatistics read;
  EXPECT_THAT(withJumps({kEarlyWheels}, clocks, read), IsEmpty());
  read.stamp_jumps = {{"odometry", {-0.25}}};
  EXPECT_EQ(withJumps({kEarlyWheels}, clocks, read).size(), 1u);
}

TEST(ClockSettings, AreSetWhenStampsWereCorrected) {
  ReadStatistics read;
  EXPECT_FALSE(isSet(kLateCamera, read));
  read.corrected = {{"stamp of 'KINECT' -0.1000 s", 7}};
  EXPECT_TRUE(isSet(kLateCamera, read));
  EXPECT_FALSE(isSet(kEarlyWheels, read));
  read.corrected = {{"stamp of odometry +0.2500 s", 7}};
  EXPECT_TRUE(isSet(kEarlyWheels, read));
  EXPECT_FALSE(isSet(kLateCamera, read));
}

TEST(ClockSettings, AFindingSaysWhoIsLateByHowMuchAndSinceWhen) {
  const Finding camera = clockFinding(kLateCamera, true);
  EXPECT_EQ(camera.severity, Severity::kWarning);
  EXPECT_EQ(camera.place, "KINECT");
  EXPECT_EQ(camera.what, "its stamps are 0.100 s (+- 0.003) too late against those of the others; they were corrected");
  ClockSetting wheels = kEarlyWheels;
  wheels.jumped = true;
  const Finding jumped = clockFinding(wheels, false);
  EXPECT_EQ(jumped.place, "wheels");
  EXPECT_EQ(jumped.what, "its stamps are 0.250 s (+- 0.010) too early against those of the others, since they jumped");
}

}  // namespace
}  // namespace roomgraph::test
