// SPDX-License-Identifier: BSD-3-Clause
// Short recordings of random flats: read back, the same bytes from world.json, light and detector as described.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <opencv2/core.hpp>

#include "roomgraph/datasets/rawlog_reader.h"
#include "roomgraph/simulation/flat.h"
#include "roomgraph/simulation/simulate.h"
#include "roomgraph/simulation/world_file.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

/// Text of a flat whose recording ends after a second.
std::string shortFlat(bool handheld) {
  std::string text = flatText({2, 1, handheld, ""});
  text.insert(text.find("\"wall_height_m\""), "\"duration_s\": 1.0, ");
  return text;
}

double meanBrightness(const std::filesystem::path& rawlog) {
  RawlogReader reader(rawlog);
  while (const auto record = reader.next())
    if (const auto* frame = std::get_if<Frame>(&*record)) {
      const cv::Scalar mean = cv::mean(frame->color);
      return (mean[0] + mean[1] + mean[2]) / 3;
    }
  return -1;
}

TEST(FlatRecording, WorldFileAndSeedMakeItAgainOnAnyNumberOfThreads) {
  const test::TemporaryFolder folder;
  SimulateOptions options;
  options.seed = 2;
  options.world_text = shortFlat(false);
  const auto first = simulate(parseWorld(options.world_text, "flat"), folder.file("a"), options);
  EXPECT_GE(first.frames, 6);
  EXPECT_GE(first.scans, 5);
  EXPECT_EQ(first.detections, first.frames);
  SimulateOptions plain;
  plain.seed = 2;
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  simulate(readWorld(folder.file("a") / "world.json"), folder.file("b"), plain);
  for (const std::string name : {"flat_2.rawlog", "boxes.jsonl", "odometry.txt", "objects.json", "groundtruth.txt", "map_truth.pgm"})
    EXPECT_TRUE(folder.read("a/" + name) == folder.read("b/" + name)) << name;
  EXPECT_FALSE(std::filesystem::exists(folder.file("b") / "world.json"));
  RawlogReader reader(first.rawlog);
  int frames = 0;
  while (const auto record = reader.next()) frames += std::holds_alternative<Frame>(*record);
  EXPECT_EQ(frames, first.frames);
  EXPECT_TRUE(reader.statistics().skipped.empty());
}

TEST(FlatRecording, AHandheldOneHasNeitherLidarNorWheels) {
  const test::TemporaryFolder folder;
  const auto result = simulate(parseWorld(shortFlat(true), "flat"), folder.file("a"), {});
  EXPECT_GE(result.frames, 6);
  EXPECT_EQ(result.scans + result.odometry, 0);
}

TEST(FlatRecording, LightScalesTheBrightness) {
  const test::TemporaryFolder folder;
  World world = parseWorld(shortFlat(true), "flat");
  world.duration_s = 0.01;
  world.camera->noise_gain = 0;
  world.light = 0.8;
  const double bright = meanBrightness(simulate(world, folder.file("a"), {}).rawlog);
  world.light = 0.4;
  const double dim = meanBrightness(simulate(world, folder.file("b"), {}).rawlog);
  EXPECT_GT(bright, 20);
  EXPECT_NEAR(dim / bright, 0.5, 0.02);
}

}  // namespace
}  // namespace roomgraph
