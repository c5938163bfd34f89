// SPDX-License-Identifier: BSD-3-Clause
// Which poses of sensors are set and to what: movements and floors of sensors whose pose is wrong by a known turn.
#include "roomgraph/pipeline/mount_settings.h"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "roomgraph/geometry/degree.h"
#include "roomgraph/pipeline/settings_json.h"

namespace roomgraph::test {
namespace {

using enum MotionSensor;
using ::testing::IsEmpty;

const LabelsOfSensors kLabels = {"LIDAR", "KINECT", ""};

// What a sensor says of 30 cm straight ahead whose recorded pose is turned by `yaw`.
Movement ahead(double yaw) {
  Vector6d sigma;
  sigma << 0.005, 0.005, 0.5, 0.5, 0.5, 0.005;
  return Movement{toPose3(Pose2{0.3 * std::cos(yaw), 0.3 * std::sin(yaw), 0}), Matrix6d(sigma.cwiseAbs2().asDiagonal())};
}

MovementAgreement driven(const std::array<std::optional<double>, 3>& yaws) {
  MovementAgreement out;
  MovementBySensor seen;
  for (std::size_t i = 0; i < 3; ++i)
    if (yaws[i]) seen[i] = ahead(*yaws[i]);
  for (int i = 0; i < 25; ++i) out.compare(i, i + 0.5, seen);
  return out;
}

// The floor as a camera sees it whose recorded pose is `error` times the right one.
CameraTilt tiltedBy(const Eigen::Quaterniond& error) {
  CameraTilt out;
  const Eigen::Vector3d camera(0, 0, 1), up = error * Eigen::Vector3d::UnitZ();
  for (int t = 0; t < 12; ++t) out.add(t, {0.2 * t, 0, 0}, Plane{up, 1 - up.dot(camera)}, camera);
  return out;
}

Eigen::Quaterniond turn(double yaw, double pitch, double roll) {
  return Eigen::Quaterniond(poseFromYpr(0, 0, 0, yaw, pitch, roll).linear());
}

TEST(MountSettings, TheOneThatIsTurnedAgainstTheOthersIsTurnedBack) {
  const double wrong = 8 * kDegree;
  for (const auto& [yaws, sensor] : {std::pair(std::array<std::optional<double>, 3>{0, wrong, 0}, kCamera),
                                     {{wrong, 0, 0}, kLidar},
                                     {{std::nullopt, wrong, 0}, kCamera},
                                     {{wrong, std::nullopt, 0}, kLidar},
                                     {{0, wrong, std::nullopt}, kCamera}}) {
    LabelsOfSensors labels = kLabels;
    for (std::size_t i = 0; i < 3; ++i)
      if (!yaws[i]) labels[i].reset();
    const auto mounts = wrongMounts(driven(yaws), {}, labels);
    ASSERT_EQ(mounts.size(), 1u);
    EXPECT_EQ(mounts[0].sensor, sensor);
    EXPECT_EQ(mounts[0].label, *kLabels[static_cast<std::size_t>(sensor)]);
    EXPECT_LT(mounts[0].turn.angularDistance(turn(-wrong, 0, 0)), 1e-6);
  }
}

TEST(MountSettings, NobodyIsTurnedWhereTheOthersDoNotSayTheSame) {
  EXPECT_THAT(wrongMounts(driven({0, 0, 8 * kDegree}), {}, kLabels), IsEmpty()) << "wheels may be mounted askew";
  EXPECT_THAT(wrongMounts(driven({-7 * kDegree, 8 * kDegree, 0}), {}, kLabels), IsEmpty()) << "three that differ blame none";
  EXPECT_THAT(wrongMounts(driven({0, 1.4 * kDegree, 0}), {}, kLabels), IsEmpty());
  EXPECT_THAT(wrongMounts({}, {}, kLabels), IsEmpty());
  EXPECT_THAT(wrongMounts(driven({8 * kDegree, std::nullopt, 0}), {}, kLabels), IsEmpty()) << "the camera is there, and has not been compared";
}

TEST(MountSettings, ACameraIsTurnedAsTheFloorAndItsWaySay) {
  const Eigen::Quaterniond tilt = turn(0, 7 * kDegree, -4 * kDegree);
  const auto level = wrongMounts({}, tiltedBy(tilt), kLabels);
  ASSERT_EQ(level.size(), 1u);
  EXPECT_EQ(level[0].sensor, kCamera);
  EXPECT_LT((level[0].turn * tilt * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitZ()).norm(), 1e-9);
  EXPECT_THAT(wrongMounts({}, tiltedBy(turn(0, 2.5 * kDegree, 0)), kLabels), IsEmpty());
  const auto both = wrongMounts(driven({0, 8 * kDegree, 0}), tiltedBy(tilt), kLabels);
  ASSERT_EQ(both.size(), 1u);
  EXPECT_LT(both[0].turn.angularDistance(turn(-8 * kDegree, 0, 0) * level[0].turn), 1e-6);
}

TEST(MountSettings, WhatIsLeftIsTurnedOnTopOfWhatWasSet) {
  const MountSetting first{kCamera, "KINECT", turn(0.1, 0.2, 0)}, second{kCamera, "KINECT", turn(-0.05, 0, 0.1)}, lidar{kLidar, "LIDAR", turn(0.3, 0, 0)};
  std::vector<MountSetting> mounts;
  addMounts({first, lidar}, mounts);
  addMounts({second}, mounts);
  ASSERT_EQ(mounts.size(), 2u);
  EXPECT_LT(mounts[0].turn.angularDistance(second.turn * first.turn), 1e-9);
  RecordCorrections corrections;
  addMounts(mounts, corrections);
  EXPECT_EQ(corrections.turns.at("KINECT"), mounts[0].turn);
  EXPECT_EQ(corrections.turns.at("LIDAR"), lidar.turn);
}

TEST(MountSettings, TheFindingSaysByWhatTheRecordedPoseIsTurned) {
  const MountSetting camera{kCamera, "KINECT", turn(8 * kDegree, -3 * kDegree, 2 * kDegree).inverse()}, lidar{kLidar, "", turn(-0.1, 0, 0)};
  EXPECT_EQ(mountFinding(camera, false).what, "its recorded pose is turned by 8.0 deg (yaw), -3.0 (pitch), 2.0 (roll)");
  EXPECT_EQ(mountFinding(camera, true).what, "its recorded pose is turned by 8.0 deg (yaw), -3.0 (pitch), 2.0 (roll); it was corrected");
  EXPECT_EQ(mountFinding(camera, true).place, "KINECT");
  EXPECT_EQ(mountFinding(lidar, true).place, "lidar");
}

TEST(SettingsJson, ComesBackToTheLastBit) {
  const MountSetting mount{kCamera, "KINECT", turn(0.1, 1.0 / 3, -0.7)};
  const ClockSetting clock{kWheels, "", {1.0 / 3, 0.01}, true};
  EXPECT_EQ(mountFrom(nlohmann::ordered_json::parse(jsonOf(mount).dump())), mount);
  EXPECT_EQ(clockFrom(nlohmann::ordered_json::parse(jsonOf(clock).dump())), clock);
  auto unknown = jsonOf(clock);
  unknown["sensor"] = "sonar";
  EXPECT_THROW(clockFrom(unknown), InputError);
}

}  // namespace
}  // namespace roomgraph::test
