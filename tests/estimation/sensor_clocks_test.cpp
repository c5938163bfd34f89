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
    for (std::size_t other = 0; other < late.size(); ++other) EXPECT_EQ(clocks.agreed(kMotionSensors[other]), other != i);
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
  for (const MotionSensor sensor : kMotionSensors) EXPECT_TRUE(clocks.agreed(sensor) && clocks.isThere(sensor));
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
  EXPECT_FALSE(one.agreed(MotionSensor::kLidar));
  EXPECT_TRUE(one.isThere(MotionSensor::kLidar));
  EXPECT_FALSE(one.isThere(MotionSensor::kCamera));
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
    EXPECT_TRUE(clocks.agreed(kMotionSensors[i])) << i;
    EXPECT_TRUE(clocks.jumped()) << i;
    EXPECT_GT(found_t, 60) << i;
    EXPECT_LT(found_t, 90) << i;
    expectOnlyWrong(clocks, i, 0.5);
  }
}

// A lidar that dies early keeps nobody from being compared, and a camera that begins late may be wrong from its start.
TEST(SensorClocks, SensorsThatDieOrBeginLate) {
  const Sensors3 sensors = sensorsOf({.camera = alwaysLate(0.2)}, 100);
  SensorClocks died;
  died.compare(until(sensors.lidar, 4), sensors.camera, sensors.wheels);
  EXPECT_FALSE(died.isThere(MotionSensor::kLidar));
  expectOnlyWrong(died, kCameraPlace, -0.2);
  SensorClocks late;
  const Trajectory none;
  late.compare(until(sensors.lidar, 40), none, until(sensors.wheels, 40));
  EXPECT_TRUE(late.agreed(MotionSensor::kLidar) && late.agreed(MotionSensor::kWheels));
  Trajectory camera;
  for (std::size_t i = 0; i < sensors.camera.size(); ++i)
    if (sensors.camera.poses()[i].t > 40) camera.add(sensors.camera.poses()[i].t, sensors.camera.poses()[i].pose);
  late.compare(sensors.lidar, camera, sensors.wheels);
  expectOnlyWrong(late, kCameraPlace, -0.2);
  EXPECT_FALSE(late.agreed(MotionSensor::kCamera));
}

// What the camera saw until then are movements of the wheels.
TEST(SensorClocks, WhatIsOnlyPredictedSaysNothing) {
  const Sensors3 sensors = sensorsOf({.camera = alwaysLate(0.2)});
  const Trajectory none;
  SensorClocks predicted, seen;
  predicted.compare(none, sensors.wheels, sensors.wheels, 200);
  EXPECT_FALSE(predicted.offsets());
  seen.compare(none, sensors.camera, sensors.wheels, 20);
  expectOnlyWrong(seen, kCameraPlace, -0.2);
}

TEST(SensorClocks, WrongClocksAreWellKnown) {
  for (const double late_s : {0.04, 0.3}) {
    const Drive drive(120, 5);
    const Trajectory lidar = seenBy(drive, {}, 6);
    const Trajectory wheels = seenBy(drive, {.rate_hz = 20, .noise_rad = 0.004, .noise_m = 0.004, .late_s = alwaysLate(late_s)}, 7);
    SensorClocks clocks;
    bool was_wrong = false;
    for (double t = 5; t < 119; t += 0.5) {
      clocks.compare(until(lidar, t), {}, until(wheels, t));
      const auto wrong = clocks.wrong();
      if (!wrong) continue;
      was_wrong = true;
      EXPECT_LT((*wrong)[kWheelsPlace].sigma, std::max(0.006, 0.125 * std::abs((*wrong)[kWheelsPlace].seconds))) << late_s << " at " << t;
    }
    EXPECT_TRUE(was_wrong) << late_s;
  }
}

// Records that say little at first: nothing is called wrong that is right, at any time.
TEST(SensorClocks, RightClocksAreNeverCalledWrong) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const Drive drive(40, 50 + seed);
    const Trajectory lidar = seenBy(drive, {.noise_rad = 0.003, .noise_m = 0.003}, seed);
    Trajectory wheels;
    Random random(1000 + seed);
    Pose2 slipped;
    const Trajectory rolled = seenBy(drive, {.rate_hz = 20, .noise_rad = 0.002}, 2000 + seed);
    for (std::size_t i = 0; i < rolled.size(); ++i) {
      if (random.uniform() < 0.02) slipped = slipped * Pose2{random.uniform(-0.1, 0.1), 0, random.uniform(-0.2, 0.2)};
      wheels.add(rolled.poses()[i].t, toPose3(planarPart(rolled.poses()[i].pose) * slipped));
    }
    SensorClocks clocks;
    for (double t = 1; t < 40; t += 0.5) {
      clocks.compare(until(lidar, t), {}, until(wheels, t));
      ASSERT_FALSE(clocks.wrong()) << "seed " << seed << " at " << t << " s: " << (*clocks.wrong())[kWheelsPlace].seconds;
    }
  }
}

}  // namespace
}  // namespace roomgraph::test
