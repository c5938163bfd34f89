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

const SensorClocks kNeverAgreed;

TEST(ClockSettings, TheStampsSayWhetherAClockJumped) {
  const StampJumpsBySensor jumps = {{"KINECT", {{5, 0.9}, {9, 0.104}}}, {"odometry", {{7, 0.25}}}};
  const ClockSetting lidar{MotionSensor::kLidar, "LIDAR", {0.17, 0.003}};
  const auto clocks = settable({kLateCamera, lidar}, kNeverAgreed, jumps);
  ASSERT_EQ(clocks.size(), 2u);
  EXPECT_TRUE(clocks[0].jumped);
  EXPECT_EQ(clocks[0].offset, (TimeOffset{-0.104, 0.003})) << "the stamps say better by how much";
  EXPECT_EQ(clocks[1], lidar);
}

// An image was left out where the clock jumped.
TEST(ClockSettings, AJumpWithAGapIsAsLongAsTheMovementsSay) {
  ClockSetting camera = kLateCamera;
  camera.offset.seconds = -0.5;
  const auto clocks = settable({camera}, kNeverAgreed, {{"KINECT", {{9, 0.63}}}});
  ASSERT_EQ(clocks.size(), 1u);
  EXPECT_TRUE(clocks[0].jumped);
  EXPECT_EQ(clocks[0].offset.seconds, -0.5);
}

TEST(ClockSettings, TheOneThatJumpedIsSetAndNotTheOneThatSeemsWrong) {
  const ClockSetting wheels{MotionSensor::kWheels, "", {0.5, 0.01}};
  const auto clocks = settable({wheels}, kNeverAgreed, {{"LIDAR", {{9, 0.5}}}});
  ASSERT_EQ(clocks.size(), 1u);
  EXPECT_EQ(clocks[0], (ClockSetting{MotionSensor::kLidar, "LIDAR", {-0.5, 0.01}, true}));
  const ClockSetting camera{MotionSensor::kCamera, "KINECT", {-0.3, 0.01}};
  const auto of_wheels = settable({camera}, kNeverAgreed, {{"odometry", {{9, -0.3}}}});
  ASSERT_EQ(of_wheels.size(), 1u);
  EXPECT_EQ(of_wheels[0], (ClockSetting{MotionSensor::kWheels, "", {0.3, 0.01}, true}));
}

TEST(ClockSettings, OfCameraAndWheelsItIsTheCameraThatJumped) {
  Trajectory camera, wheels;
  for (int i = 0; i < 10; ++i) {
    camera.add(0.1 * i, Pose3::Identity());
    wheels.add(0.1 * i, Pose3::Identity());
  }
  SensorClocks clocks;
  clocks.compare({}, camera, wheels);
  const auto found = settable({{MotionSensor::kWheels, "", {0.5, 0.01}}}, clocks, {{"KINECT", {{9, 0.5}}}});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0], (ClockSetting{MotionSensor::kCamera, "KINECT", {-0.5, 0.01}, true}));
}

TEST(ClockSettings, ClocksThatWereRightAndComeApartAreNotSet) {
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
  ASSERT_TRUE(clocks.agreed(MotionSensor::kWheels));
  EXPECT_THAT(settable({kEarlyWheels}, clocks, {}), IsEmpty());
  EXPECT_EQ(settable({kEarlyWheels}, clocks, {{"odometry", {{30, -0.25}}}}).size(), 1u);
  EXPECT_EQ(settable({kLateCamera}, clocks, {}).size(), 1u) << "it was not there before";
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
