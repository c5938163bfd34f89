// SPDX-License-Identifier: BSD-3-Clause
// Simulated recordings read back against their truth; same bytes for the same seed.
#include "roomgraph/simulation/simulate.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "example_world.h"
#include "roomgraph/datasets/rawlog_reader.h"
#include "scene.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

World shortWorld() {
  World world = test::exampleWorld();
  world.duration_s = 0.45;
  world.detections = DetectionsSpec{};
  return world;
}

std::size_t lines(const std::string& text) {
  std::size_t count = 0;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) count += line[0] != '#';
  return count;
}

TEST(Simulate, TheRecordingReadsBackWithItsTruth) {
  const test::TemporaryFolder folder;
  const World world = shortWorld();
  const Scene scene(world);
  const auto result = simulate(world, folder.path(), {});
  EXPECT_EQ(result.frames, 5);
  EXPECT_EQ(result.scans, 5);
  EXPECT_EQ(result.odometry, 10);
  RawlogReader reader(result.rawlog);
  int frames = 0, scans = 0, readings = 0, detections = 0;
  double last = 0;
  while (const auto record = reader.next()) {
    EXPECT_GE(timeOf(*record), last);
    last = timeOf(*record);
    if (const auto* frame = std::get_if<Frame>(&*record)) {
      ++frames;
      EXPECT_EQ(frame->sensor_label, "KINECT");
      EXPECT_EQ(frame->color.size(), cv::Size(640, 480));
      EXPECT_LT((frame->robot_from_camera.matrix() - scene.robotFromCamera().matrix()).norm(), 1e-6);
      EXPECT_EQ(frame->camera, world.camera->model);
      // The wall ahead, within the noise model (sigma of 4 cm there).
      const double ahead = 5 - scene.worldFromCamera(frame->t - 1700000000).translation().x();
      EXPECT_NEAR(frame->depthAt(320, 150), ahead, 0.2);
    } else if (const auto* scan = std::get_if<Scan>(&*record)) {
      ++scans;
      EXPECT_EQ(scan->ranges_m.size(), 360u);
    } else if (std::holds_alternative<OdometryReading>(*record)) {
      ++readings;
    } else {
      ++detections;
    }
  }
  EXPECT_TRUE(reader.statistics().skipped.empty());
  EXPECT_EQ(frames, 5);
  EXPECT_EQ(scans, 5);
  EXPECT_EQ(readings, 10);
  EXPECT_EQ(detections, 5);
  EXPECT_EQ(lines(folder.read("groundtruth.txt")), 5u);
  EXPECT_EQ(lines(folder.read("groundtruth_robot.txt")), 10u);
  EXPECT_EQ(lines(folder.read("odometry.txt")), 10u);
  EXPECT_EQ(lines(folder.read("boxes.jsonl")), 5u);
  EXPECT_EQ(lines(folder.read("persons.txt")), 5u);
  EXPECT_EQ(folder.read("map_truth.pgm").substr(0, 2), "P5");
  const auto objects = nlohmann::json::parse(folder.read("objects.json"));
  ASSERT_EQ(objects["objects"].size(), 3u);
  EXPECT_EQ(objects["objects"][0]["kind"], "block");
  EXPECT_EQ(objects["objects"][0]["x"], 3.5);
  EXPECT_TRUE(nlohmann::json::parse(folder.read("calibration.json")).contains("robot_from_lidar"));
}

TEST(Simulate, AnInstantOfTwoSensorsHasOneTruth) {
  const test::TemporaryFolder folder;
  World world = shortWorld();
  world.lidar->delay_s = 0;
  const auto result = simulate(world, folder.path(), {});
  EXPECT_EQ(result.frames, 5);
  EXPECT_EQ(result.scans, 5);
  EXPECT_EQ(lines(folder.read("groundtruth_robot.txt")), 5u);
}

TEST(Simulate, TheSameSeedGivesTheSameBytes) {
  const test::TemporaryFolder folder;
  const World world = shortWorld();
  SimulateOptions other;
  other.seed = 2;
  simulate(world, folder.file("a"), {});
  simulate(world, folder.file("b"), {});
  simulate(world, folder.file("c"), other);
  for (const std::string name :
       {"example.rawlog", "boxes.jsonl", "odometry.txt", "objects.json", "map_truth.pgm"})
    EXPECT_TRUE(folder.read("a/" + name) == folder.read("b/" + name)) << name;
  for (const std::string name : {"example.rawlog", "odometry.txt"})
    EXPECT_FALSE(folder.read("a/" + name) == folder.read("c/" + name)) << name;
  EXPECT_TRUE(folder.read("a/groundtruth.txt") == folder.read("c/groundtruth.txt"));
}

TEST(Simulate, AnInterruptedRecordingIsComplete) {
  const test::TemporaryFolder folder;
  int asked = 0;
  SimulateOptions options;
  options.interrupted = [&] { return ++asked > 9; };
  const auto result = simulate(shortWorld(), folder.path(), options);
  EXPECT_TRUE(result.interrupted);
  EXPECT_GT(result.frames, 0);
  EXPECT_LT(result.frames, 5);
  RawlogReader reader(result.rawlog);
  int records = 0;
  while (reader.next()) ++records;
  EXPECT_EQ(records, 9 + result.detections);
  EXPECT_TRUE(reader.statistics().warning.empty());
  EXPECT_EQ(lines(folder.read("groundtruth.txt")), static_cast<std::size_t>(result.frames));
  EXPECT_EQ(lines(folder.read("odometry.txt")), static_cast<std::size_t>(result.odometry));
  EXPECT_FALSE(folder.read("objects.json").empty());
}

}  // namespace
}  // namespace roomgraph
