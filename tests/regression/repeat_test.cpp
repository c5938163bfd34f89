// SPDX-License-Identifier: BSD-3-Clause
// Repeatability of runs: same bits for any number of threads, own config, and interruption by signals.
#include <signal.h>
#include <string.h>

#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "program.h"
#include "rated_networks.h"
#include "temporary_folder.h"
#include "tiny_recording.h"

namespace roomgraph::test {
namespace {

std::map<std::string, std::string> filesOf(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  const std::set<std::string> timed{"summary.json", "timings.csv", "report.html"};
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (const std::string name = entry.path().filename(); !timed.contains(name))
      files[name] = contentOf(entry.path());
  return files;
}

void expectSameFiles(const std::filesystem::path& a, const std::filesystem::path& b) {
  const auto first = filesOf(a), second = filesOf(b);
  EXPECT_GE(first.size(), 11u);
  for (const auto& [name, content] : first)
    EXPECT_TRUE(second.contains(name) && second.at(name) == content) << name << " differs";
  EXPECT_EQ(first.size(), second.size());
}

// The files of three runs, one of them with one thread and one with four, are the same bits; returns their folder.
std::filesystem::path expectSameBits(const TemporaryFolder& folder, const std::filesystem::path& recording,
                                     const std::vector<std::string>& options = {}) {
  const auto run = [&](const std::string& output, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"run", recording.string(), "-o", folder.file(output).string(), "--quiet"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    const CallResult result = call(folder.path(), arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return folder.file(output);
  };
  const auto first = run("first", {}), single = run("single", {"--threads", "1"}),
             four = run("four", {"--threads", "4"});
  expectSameFiles(first, single);
  expectSameFiles(first, four);
  return first;
}

TEST(Repeat, SameInputGivesTheSameBitsWhateverTheThreads) {
  TemporaryFolder folder;
  test::writeRawlog(folder.file("tiny.rawlog"), TinyRecording(30).records({}));
  expectSameBits(folder, folder.file("tiny.rawlog"));
}

TEST(Repeat, SameObjectsWhateverTheThreads) {
  TemporaryFolder folder;
  const auto out =
      expectSameBits(folder, std::filesystem::path(ROOMGRAPH_SOURCE_DIR) / "rawlogs" / "tiny_room.rawlog");
  const auto landmarks = nlohmann::json::parse(contentOf(out / "landmarks.json")).at("landmarks");
  EXPECT_GE(landmarks.size(), 3u) << "its recorded boxes were used";
  EXPECT_GT(linesOf(contentOf(out / "associations.jsonl")).size(), 30u);
}

// Each network's turn depends on the times of images alone; recorded, its boxes give the same map.
TEST(Repeat, SameBoxesOfNetworksWithRatesWhateverTheThreads) {
  TemporaryFolder folder;
  const auto room = std::filesystem::path(ROOMGRAPH_SOURCE_DIR) / "rawlogs" / "tiny_room.rawlog";
  const auto out = expectSameBits(folder, room, ratedNetworks(folder.path()));
  EXPECT_NE(contentOf(out / "detections.jsonl").find("\"unsought\":[\"door\"]"), std::string::npos)
      << "images on which nobody looked for doors";
  const CallResult again = call(folder.path(), {"run", room.string(), "-o", folder.file("again").string(), "--quiet", "--set",
                                                "detection.file=\"" + (out / "detections.jsonl").string() + "\""});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  for (const char* name : {"landmarks.json", "trajectory.tum", "associations.jsonl", "live.tum"})
    EXPECT_TRUE(contentOf(out / name) == contentOf(folder.file("again") / name)) << name << " differs";
}

// Names of files that mean something in an INI file come back from the run's own config.
TEST(Repeat, FromTheConfigOfARunInAFolderWithAnOddName) {
  TemporaryFolder folder;
  const auto odd = folder.path() / "a #1, b";
  const std::filesystem::path source = ROOMGRAPH_SOURCE_DIR;
  std::filesystem::create_directories(odd);
  const auto room = source / "rawlogs" / "tiny_room.rawlog";
  const auto run = [&](const std::string& output, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"run", room.string(), "-o", output, "--quiet", "--no-snapshot"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const CallResult result = call(folder.path(), arguments, odd);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return odd / output;
  };
  std::filesystem::copy_file(run("boxes", {}) / "detections.jsonl", odd / "boxes.jsonl");
  const auto first = run("first", {"--set", "detection.file=boxes.jsonl"});
  EXPECT_NE(contentOf(first / "config.ini").find("file = \"" + (odd / "boxes.jsonl").string() + "\"\n"),
            std::string::npos);
  const auto second = run("second", {"--config", "first/config.ini"});
  for (const char* name : {"config.ini", "landmarks.json", "trajectory.tum", "detections.jsonl"})
    EXPECT_TRUE(contentOf(first / name) == contentOf(second / name)) << name << " differs";
  const CallResult onto = call(
      folder.path(),
      {"run", room.string(), "-o", "first", "--quiet", "--set", "detection.file=\"first/detections.jsonl\""},
      odd);
  expectOneLine(onto, 2, ::testing::HasSubstr("would be replaced by its results"));
}

// The replay is interrupted as soon as the first live poses are on disk.
class Interrupt : public ::testing::TestWithParam<int> {};

TEST_P(Interrupt, EndsTheReplayAndKeepsWhatItFound) {
  constexpr int kSteps = 1500;
  TemporaryFolder folder;
  test::writeRawlog(folder.file("long.rawlog"), TinyRecording(kSteps).records({true, false, true}), false);
  const auto out = folder.path() / "out";
  Program program(folder.path(), {"run", folder.file("long.rawlog").string(), "-o", out.string(), "--quiet"});
  for (int i = 0; i < 3000; ++i) {
    std::error_code none_yet;
    if (std::filesystem::file_size(out / "roomgraph_unfinished" / "live.tum", none_yet) > 0 && !none_yet)
      break;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ASSERT_EQ(kill(program.pid(), GetParam()), 0);
  const CallResult result = program.wait();
  expectOneLine(result, 4, ::testing::HasSubstr("interrupted"));
  const auto poses = linesOf(contentOf(out / "trajectory.tum"));
  EXPECT_GT(poses.size(), 10u);
  EXPECT_LT(poses.size(), static_cast<std::size_t>(kSteps)) << "it was not interrupted";
  EXPECT_EQ(linesOf(contentOf(out / "live.tum")).size(), poses.size());
  const auto summary = nlohmann::json::parse(contentOf(out / "summary.json"));
  EXPECT_EQ(summary["interrupted"], "yes");
  EXPECT_GT(summary["replay"]["to_s"], 0.5);
  EXPECT_LT(summary["replay"]["share_of_span"], 1);
  EXPECT_EQ(summary["counts"]["scans"], poses.size());
  EXPECT_TRUE(contentOf(out / "snapshot.png").starts_with("\x89PNG"));
}

INSTANTIATE_TEST_SUITE_P(EverySignal, Interrupt, ::testing::Values(SIGINT, SIGTERM, SIGHUP),
                         [](const auto& signal) { return std::string(sigabbrev_np(signal.param)); });

}  // namespace
}  // namespace roomgraph::test
