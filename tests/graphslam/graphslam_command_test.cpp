// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph graphslam`: MRPT's parts, ours and mixtures of both against the truth; errors; interruption.
#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "../regression/program.h"
#include "../regression/tiny_recording.h"
#include "roomgraph/evaluation/trajectory_error.h"
#include "roomgraph/evaluation/trajectory_file.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

using namespace roomgraph::test;
using ::testing::HasSubstr;

const std::string kSources = ROOMGRAPH_SOURCE_DIR;
const std::string kRoom = kSources + "/rawlogs/tiny_room.rawlog", kIni = kSources + "/share/mrpt/graphslam.ini";

std::vector<std::string> withIni(std::vector<std::string> words) {
  words.insert(words.begin(), "graphslam");
  for (const char* word : {"--ini", kIni.c_str(), "--quiet", "--set", "tracking.max_features=900"}) words.push_back(word);
  return words;
}

double errorOf(const std::filesystem::path& out) {
  const auto errors = evaluateTrajectory(readTrajectory(kSources + "/share/mrpt/tiny_room.groundtruth.txt").trajectory,
                                         readTrajectory(out / "trajectory.tum").trajectory);
  EXPECT_GT(errors.coverage, 0.95);
  return errors.ate_m.rmse;
}

/// Parts of an engine, and how far its path in the tiny room may be off. Wheels alone are 0.08 m off.
struct Mixture {
  std::string node, edges, optimizer, dimensions;
  double limit_m;
};

class GraphSlam : public ::testing::TestWithParam<Mixture> {};

TEST_P(GraphSlam, FollowsTheRobot) {
  const Mixture& mixture = GetParam();
  const TemporaryFolder folder;
  const auto out = folder.path() / "out";
  const auto run = call(folder.path(), withIni({kRoom, "-o", out.string(), "-n", mixture.node, "-e", mixture.edges, "-p",
                                                mixture.optimizer, "--dimensions", mixture.dimensions}));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err, "") << "MRPT is to be quiet";
  EXPECT_LT(errorOf(out), mixture.limit_m);
  const auto summary = nlohmann::json::parse(contentOf(out / "summary.json"));
  EXPECT_GE(summary["nodes"], 10);
  EXPECT_GE(summary["edges"], summary["nodes"].get<int>() - 1);
  EXPECT_EQ(summary["optimizer"], mixture.optimizer);
  const std::string graph = contentOf(out / "output_graph.graph");
  EXPECT_THAT(graph, HasSubstr(mixture.dimensions == "2" ? "VERTEX_SE2 1 " : "VERTEX3 1 "));
  for (const char* report : {"CGraphSlamEngine.log", "node_registrar.log", "edge_registrar.log", "optimizer.log", "timings.log"})
    EXPECT_FALSE(contentOf(out / report).empty()) << report;
  EXPECT_EQ(std::filesystem::exists(out / "output_map.png"), mixture.dimensions == "2");
}

INSTANTIATE_TEST_SUITE_P(
    Mixtures, GraphSlam,
    ::testing::Values(Mixture{"CFixedIntervalsNRD", "CICPCriteriaERD", "CLevMarqGSO", "2", 0.05},
                      Mixture{"CKeyPosesNRD", "CScanClosuresERD+CImageClosuresERD", "CFactorGraphGSO", "2", 0.015},
                      Mixture{"CFixedIntervalsNRD", "CICPCriteriaERD+CScanClosuresERD", "CFactorGraphGSO", "2", 0.05},
                      Mixture{"CKeyPosesNRD", "CEmptyERD", "CEmptyGSO", "2", 0.03},
                      Mixture{"CKeyPosesNRD", "CImageClosuresERD", "CFactorGraphGSO", "3", 0.015},
                      Mixture{"CFixedIntervalsNRD", "CEmptyERD", "CLevMarqGSO", "3", 0.12}));

TEST(GraphSlamCommand, IsAsGoodAsARun) {
  const TemporaryFolder folder;
  const auto ours = folder.path() / "ours", run = folder.path() / "run";
  ASSERT_EQ(call(folder.path(), withIni({kRoom, "-o", ours.string()})).exit_code, 0);
  ASSERT_EQ(call(folder.path(), {"run", kRoom, "-o", run.string(), "--quiet", "--no-report", "--no-snapshot", "--set",
                                 "tracking.max_features=900"})
                .exit_code,
            0);
  EXPECT_LT(errorOf(ours), errorOf(run) + 0.006);
}

TEST(GraphSlamCommand, AnnotatesNodesWithObjects) {
  const TemporaryFolder folder;
  const auto out = folder.path() / "out";
  const auto run = call(folder.path(), withIni({kRoom, "-o", out.string(), "-e", "CScanClosuresERD+CObjectClosuresERD"}));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto lines = linesOf(contentOf(out / "output_graph.graph"));
  const auto annotated = std::count_if(lines.begin(), lines.end(), [](const auto& line) {
    return line.starts_with("VERTEX_SE2") && line.find(" | ") != std::string::npos && line.find("swivel_chair ") != std::string::npos;
  });
  EXPECT_GE(annotated, 5);
  const auto objects = nlohmann::json::parse(contentOf(out / "landmarks.json"))["landmarks"];
  // The robot begins at (0.8, 1.2) of the room, facing along x.
  int chairs = 0;
  for (const auto& object : objects) {
    if (object["class"] != "swivel_chair") continue;
    const double x = object["x"].get<double>() + 0.8, y = object["y"].get<double>() + 1.2;
    EXPECT_LT(std::min(std::hypot(x - 3.3, y - 2.75), std::hypot(x - 3.85, y - 1.95)), 0.25);
    ++chairs;
  }
  EXPECT_EQ(chairs, 2);
}

TEST(GraphSlamCommand, GivesTheSameTwice) {
  const TemporaryFolder folder;
  for (const char* name : {"a", "b"})
    ASSERT_EQ(call(folder.path(), withIni({kRoom, "-o", (folder.path() / name).string()})).exit_code, 0);
  for (const char* file : {"trajectory.tum", "output_graph.graph"})
    EXPECT_EQ(contentOf(folder.path() / "a" / file), contentOf(folder.path() / "b" / file));
}

TEST(GraphSlamCommand, ErrorsAreOneLineWithTheirCode) {
  const TemporaryFolder folder;
  const std::string out = folder.file("out").string();
  const auto fails = [&](std::vector<std::string> words, int code, const std::string& text) {
    expectOneLine(call(folder.path(), withIni(std::move(words))), code, HasSubstr(text));
  };
  fails({kRoom}, 2, "--output is required");
  fails({kRoom, "-o", out, "-n", "CKeyPoseNRD"}, 2, "did you mean 'CKeyPosesNRD'");
  fails({kRoom, "-o", out, "--dimensions", "3", "-e", "CICPCriteriaERD"}, 2, "planar poses alone");
  fails({kRoom, "-o", out, "-n", "CEmptyNRD"}, 1, "CEmptyNRD registered no node");
  fails({folder.file("none.rawlog").string(), "-o", out}, 3, "no such file");
  fails({kIni, "-o", out}, 3, "not a rawlog");
  fails({kRoom, "-o", out, "-n", "CICPCriteriaNRD"}, 1, "record 1: the engine failed: Not yet implemented");  // with images
  fails({kRoom, "-o", out, "--truth", kSources + "/README.md"}, 3, "README.md");
  fails({kRoom, "-o", folder.write("file", "").string() + "/out"}, 1, "file");
  expectOneLine(call(folder.path(), {"graphslam", kRoom, "--ini", folder.file("no.ini").string(), "-o", out}), 2,
                HasSubstr("no.ini: no such file"));
  expectOneLine(call(folder.path(), withIni({kRoom, "-o", out, "-e", "CLoopCloserERD"})), 2, HasSubstr("segmentation fault"));
  expectOneLine(call(folder.path(), withIni({kRoom, "-o", out, "--window"}), std::filesystem::current_path(),
                     {"DISPLAY=", "WAYLAND_DISPLAY="}),
                1, HasSubstr("there is no display"));
  EXPECT_FALSE(std::filesystem::exists(std::filesystem::path(out) / "summary.json"));
}

TEST(GraphSlamCommand, ListsItsParts) {
  const TemporaryFolder folder;
  const auto listed = call(folder.path(), {"graphslam", "--list"});
  EXPECT_EQ(listed.exit_code, 0);
  for (const char* name : {"CKeyPosesNRD", "CICPCriteriaERD", "CObjectClosuresERD", "CFactorGraphGSO"})
    EXPECT_THAT(listed.out, HasSubstr(name));
}

TEST(GraphSlamCommand, AnInterruptLeavesWhatWasDone) {
  const TemporaryFolder folder;
  const auto out = folder.path() / "out", share = folder.file("share.txt");
  writeRawlog(folder.file("long.rawlog"), TinyRecording(3000).records({true, false, true}), false);
  Program program(folder.path(), withIni({folder.file("long.rawlog").string(), "-o", out.string(), "-e", "CEmptyERD",
                                          "--progress-file", share.string()}));
  for (int i = 0; i < 3000 && std::strtod(contentOf(share).c_str(), nullptr) < 0.02; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  ASSERT_EQ(kill(program.pid(), SIGINT), 0);
  expectOneLine(program.wait(), 4, HasSubstr("interrupted: the results cover"));
  const auto summary = nlohmann::json::parse(contentOf(out / "summary.json"));
  EXPECT_EQ(summary["interrupted"], true);
  EXPECT_LT(summary["share"], 1);
  EXPECT_GT(readTrajectory(out / "trajectory.tum").trajectory.size(), 10u);
  EXPECT_THAT(contentOf(out / "output_graph.graph"), HasSubstr("EDGE_SE2 0 1 "));
}

TEST(GraphSlamCommand, ABrokenEndCostsTheEnd) {
  const TemporaryFolder folder;
  const std::string all = contentOf(kRoom);
  folder.write("cut.rawlog", all.substr(0, all.size() / 2));
  const auto out = folder.path() / "out";
  const auto run = call(folder.path(), withIni({folder.file("cut.rawlog").string(), "-o", out.string()}));
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.err, HasSubstr("warning: the file ends in the middle of a record"));
  EXPECT_GE(nlohmann::json::parse(contentOf(out / "summary.json"))["nodes"], 4);
}

// MRPT's demo of its engine, a simulated robot with noisy wheels; Debian's package mrpt-common has it.
TEST(GraphSlamCommand, FollowsTheRobotOfMrptsDemo) {
  const std::filesystem::path demo =
      "/usr/share/mrpt/datasets/graphslam-engine-demos/action_observations_map/range_030_bearing_015.rawlog";
  const std::string truth = demo.string() + ".GT.txt";
  if (!std::filesystem::exists(demo) || !std::filesystem::exists(truth)) GTEST_SKIP() << "missing: " << demo;
  const TemporaryFolder folder;
  const auto out = folder.path() / "out";
  const auto run = call(folder.path(), withIni({demo.string(), "-o", out.string(), "--truth", truth}));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto errors =
      evaluateTrajectory(readTrajectory(truth).trajectory, readTrajectory(out / "trajectory.tum").trajectory);
  EXPECT_LT(errors.ate_m.rmse, 0.8);
  EXPECT_FALSE(contentOf(out / "SLAM_evaluation_metric.log").empty());
}

}  // namespace
}  // namespace roomgraph
