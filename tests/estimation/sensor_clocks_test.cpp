// SPDX-License-Identifier: BSD-3-Clause
// Who of lidar, camera and wheels has another clock: the one that was given one.
#include "roomgraph/estimation/sensor_clocks.h"

#include <gtest/gtest.h>

#include "timed_paths.h"

namespace roomgraph::test {
namespace {

constexpr std::size_t kLidarPlace = 0, kCameraPlace = 1, kWheelsPlace = 2;

struct Lateness {
  std::function<double(double)> lidar = alwaysLate(0), camera = alwaysLate(0), wheels = alwaysLate(0);
};

struct Sensors3 {
  Trajectory lidar, camera, wheels;
};

Sensors3 sensorsOf(const Lateness& late, double seconds = 90) {
  const Drive drive(seconds, 1);
  return {seenBy(drive, {.late_s = late.lidar}, 2), seenBy(drive, {.rate_hz = 15, .late_s = late.camera}, 3),
          seenBy(drive, {.rate_hz = 20, .noise_rad = 0.002, .late_s = late.wheels}, 4)};
}

Trajectory until(const Trajectory& all, double t) {
  Trajectory out;
  for (std::size_t i = 0; i < all.size() && all.poses()[i].t <= t; ++i) out.add(all.poses()[i].t, all.poses()[i].pose);
  return out;
}

void expectOnlyWrong(const SensorClocks& clocks, std::size_t sensor, double seconds) {
  const auto wrong = clocks.wrong();
  ASSERT_TRUE(wrong) << sensor;
  for (std::size_t i = 0; i < wrong->size(); ++i) {
    if (i == sensor)
      EXPECT_NEAR((*wrong)[i].seconds, seconds, 0.008);
    else
      EXPECT_EQ((*wrong)[i].seconds, 0) << i;
  }
}

TEST(SensorClocks, TheOneThatTwoOthersDifferFromIsWrong) {
  const std::array late = {Lateness{.lidar = alwaysLate(0.1)}, Lateness{.camera = alwaysLate(0.1)}, Lateness{.wheels = alwaysLate(0.1)}};
  for (std::size_t i = 0; i < late.size(); ++i) {
    const Sensors3 sensors = sensorsOf(late[i]);
    SensorClocks clocks;
    clocks.compare(sensors.lidar, sensors.camera, sensors.wheels);
    expectOnlyWrong(clocks, i, -0.1);
    EXPECT_FALSE(clocks.agreed());
    EXPECT_FALSE(clocks.jumped());
  }
}

TEST(SensorClocks, OfTwoThatOfTheLidarIsRightOrThatOfTheWheels) {
  const Sensors3 sensors = sensorsOf({.lidar = alwaysLate(0.1), .camera = alwaysLate(-0.2)});
  const Trajectory none;
  SensorClocks lidar_wheels, lidar_camera, camera_wheels;
  lidar_wheels.compare(sensors.lidar, none, sensors.wheels);
  expectOnlyWrong(lidar_wheels, kWheelsPlace, 0.1);
  lidar_camera.compare(sensors.lidar, sensors.camera, none);
  expectOnlyWrong(lidar_camera, kCameraPlace, 0.3);
  camera_wheels.compare(none, sensors.camera, sensors.wheels);
  expectOnlyWrong(camera_wheels, kCameraPlace, 0.2);
}

TEST(SensorClocks, WhereAllDifferAllAreSetToTheLidar) {
  const Sensors3 sensors = sensorsOf({.lidar = alwaysLate(0.1), .camera = alwaysLate(-0.2)});
  SensorClocks clocks;
  clocks.compare(sensors.lidar, sensors.camera, sensors.wheels);
  const auto wrong = clocks.wrong();
  ASSERT_TRUE(wrong);
  EXPECT_EQ((*wrong)[kLidarPlace].seconds, 0);
  EXPECT_NEAR((*wrong)[kCameraPlace].seconds, 0.3, 0.008);
  EXPECT_NEAR((*wrong)[kWheelsPlace].seconds, 0.1, 0.008);
}

TEST(SensorClocks, ClocksThatAgreeAreNotWrong) {
  const Sensors3 sensors = sensorsOf({.camera = alwaysLate(0.01)});
  SensorClocks clocks;
  clocks.compare(sensors.lidar, sensors.camera, sensors.wheels);
  ASSERT_TRUE(clocks.offsets());
  EXPECT_NEAR((*clocks.offsets())[kCameraPlace].seconds, -0.01, 0.006);
  EXPECT_FALSE(clocks.wrong());
  EXPECT_TRUE(clocks.agreed());
}

TEST(SensorClocks, ALittleDrivingAndOneSensorSayNothing) {
  const Sensors3 sensors = sensorsOf({.camera = alwaysLate(0.1)}, 4);
  SensorClocks little, one;
  little.compare(sensors.lidar, sensors.camera, sensors.wheels);
  EXPECT_FALSE(little.offsets());
  EXPECT_FALSE(little.wrong());
  const Trajectory none;
  one.compare(sensorsOf({}).lidar, none, none);
  EXPECT_FALSE(one.offsets());
  EXPECT_FALSE(one.agreed());
}

// All others are compared with the lidar: until both have noticed, it is not known who has jumped.
TEST(SensorClocks, TheOneThatJumpsIsWrongFromThenOn) {
  const std::function<double(double)> jump = [](double t) { return t < 60 ? 0 : -0.5; };
  const std::array late = {Lateness{.lidar = jump}, Lateness{.camera = jump}, Lateness{.wheels = jump}};
  for (std::size_t i = 0; i < late.size(); ++i) {
    const Sensors3 sensors = sensorsOf(late[i], 120);
    SensorClocks clocks;
    double found_t = 0;
    for (double t = 1; t < 119 && found_t == 0; t += 0.5) {
      clocks.compare(until(sensors.lidar, t), until(sensors.camera, t), until(sensors.wheels, t));
      if (clocks.wrong()) found_t = t;
    }
    EXPECT_TRUE(clocks.agreed()) << i;
    EXPECT_TRUE(clocks.jumped()) << i;
    EXPECT_GT(found_t, 60) << i;
    EXPECT_LT(found_t, 90) << i;
    expectOnlyWrong(clocks, i, 0.5);
  }
}

}  // namespace
}  // namespace roomgraph::test
