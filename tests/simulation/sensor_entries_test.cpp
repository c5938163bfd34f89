// SPDX-License-Identifier: BSD-3-Clause
// Sensor entries of world files: every key reaches its field in SI units, and impossible values are refused.
#include <gmock/gmock.h>

#include "errors_of.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/geometry/degree.h"
#include "sensor_entries.h"

namespace roomgraph {
namespace {

using ::testing::HasSubstr;

World sensorsOf(const std::string& text, bool robot = true) {
  World world;
  if (robot)
    world.robot.emplace();
  else
    world.handheld.emplace();
  readSensors(JsonEntry(nlohmann::json::parse(text), "w.json", "sensors"), world);
  return world;
}

std::string sensorError(const std::string& text, bool robot = true) {
  return test::messageOf<ConfigError>([&] { sensorsOf(text, robot); });
}

TEST(SensorEntries, Camera) {
  const auto camera = *sensorsOf(R"({"camera": {"rate_hz": 5, "at_m": [0.1, 0.2, 0.9], "pitch_down_deg": 30,
      "width_px": 320, "height_px": 200, "near_m": 0.3, "far_m": 4, "noise": 0.5, "jpeg_quality": 70}})").camera;
  EXPECT_EQ(camera.rate_hz, 5);
  EXPECT_EQ(camera.at_m, Eigen::Vector3d(0.1, 0.2, 0.9));
  EXPECT_NEAR(camera.pitch_down_rad, 30 * kDegree, 1e-12);
  // A picture of half the width has half the focal length: the angle of view stays.
  EXPECT_EQ(camera.model, (PinholeCamera{320, 200, 262.5, 262.5, 159.5, 99.5, {}}));
  EXPECT_EQ(camera.focal_px, 290);
  EXPECT_EQ(camera.near_m, 0.3);
  EXPECT_EQ(camera.far_m, 4);
  EXPECT_EQ(camera.noise_gain, 0.5);
  EXPECT_EQ(camera.jpeg_quality, 70);
  EXPECT_EQ(sensorsOf(R"({"camera": {"focal_px": 300}})").camera->model.fy, 300);
  EXPECT_EQ(sensorsOf(R"({"camera": {}})").camera->model, CameraSpec{}.model);
}

TEST(SensorEntries, Lidar) {
  const auto lidar = *sensorsOf(R"({"lidar": {"rate_hz": 7, "beams": 180, "at_m": [1, 2, 0.5], "range_min_m": 0.2,
      "range_max_m": 12, "sigma_m": 0.03, "sigma_relative": 0.04, "dropouts": 0.05}})").lidar;
  EXPECT_EQ(lidar.rate_hz, 7);
  EXPECT_EQ(lidar.beams, 180);
  EXPECT_EQ(lidar.at_m, Eigen::Vector3d(1, 2, 0.5));
  EXPECT_EQ(lidar.min_m, 0.2);
  EXPECT_EQ(lidar.max_m, 12);
  EXPECT_EQ(lidar.sigma_m, 0.03);
  EXPECT_EQ(lidar.sigma_relative, 0.04);
  EXPECT_EQ(lidar.dropouts, 0.05);
}

TEST(SensorEntries, OdometryAndItsCommonNoiseGain) {
  const auto odometry = *sensorsOf(R"({"odometry": {"rate_hz": 50, "noise": 2, "scale_error": 0.1, "turn_error": -0.1,
      "drift_deg_m": 3, "sigma_length": 0.01, "sigma_turn": 0.02, "slips": 4, "slip_m": 0.3, "slip_deg": 9}})").odometry;
  EXPECT_EQ(odometry.rate_hz, 50);
  EXPECT_NEAR(odometry.scale_error, 0.2, 1e-12);
  EXPECT_NEAR(odometry.turn_error, -0.2, 1e-12);
  EXPECT_NEAR(odometry.drift_rad_m, 6 * kDegree, 1e-12);
  EXPECT_NEAR(odometry.sigma_length, 0.02, 1e-12);
  EXPECT_NEAR(odometry.sigma_turn, 0.04, 1e-12);
  EXPECT_EQ(odometry.slips, 4);
  EXPECT_NEAR(odometry.slip_m, 0.6, 1e-12);
  EXPECT_NEAR(odometry.slip_rad, 18 * kDegree, 1e-12);
  const auto none = *sensorsOf(R"({"odometry": {"noise": 0}})").odometry;
  for (const double error : {none.scale_error, none.turn_error, none.drift_rad_m, none.sigma_length, none.sigma_turn,
                             none.slip_m, none.slip_rad})
    EXPECT_EQ(error, 0);
}

TEST(SensorEntries, Detections) {
  const auto detector = *sensorsOf(R"({"camera": {}, "detections": {"detect_probability": 0.7, "min_visible": 0.4,
      "min_height_px": 33, "jitter": 0.01, "false_positives": 0.2, "confusion": 0.15}})").detections;
  EXPECT_EQ(detector.detect_probability, 0.7);
  EXPECT_EQ(detector.min_visible, 0.4);
  EXPECT_EQ(detector.min_height_px, 33);
  EXPECT_EQ(detector.jitter, 0.01);
  EXPECT_EQ(detector.false_positives, 0.2);
  EXPECT_EQ(detector.confusion, 0.15);
}

TEST(SensorEntries, ImpossibleOnesAreRefused) {
  EXPECT_THAT(sensorError("{}"), HasSubstr("at least one sensor"));
  EXPECT_THAT(sensorError(R"({"lidar": {}, "detections": {}})"), HasSubstr("sensors.detections: need a camera"));
  EXPECT_THAT(sensorError(R"({"camera": {"near_m": 2, "far_m": 1}})"), HasSubstr("sensors.camera.far_m"));
  EXPECT_THAT(sensorError(R"({"lidar": {"range_min_m": 2, "range_max_m": 1}})"), HasSubstr("sensors.lidar.range_max_m"));
  EXPECT_THAT(sensorError(R"({"lidar": {"at_m": [0, 0, 3.1]}})"), HasSubstr("the height must be in [0, 3] m"));
  EXPECT_THAT(sensorError(R"({"lidar": {}, "sonar": {}})"), HasSubstr("sensors.sonar: unknown key"));
  for (const std::string wheeled : {"lidar", "odometry"})
    EXPECT_THAT(sensorError("{\"camera\": {}, \"" + wheeled + "\": {}}", false),
                HasSubstr("sensors." + wheeled + ": a hand-held camera has none"));
}

}  // namespace
}  // namespace roomgraph
